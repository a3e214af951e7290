#include "sim/world/file_cameras.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/world/mesh_import.h"
#include "sim/world/texture_file.h"

namespace sim {
namespace {

std::vector<FileCamera> CamerasOf(const WorldDescription& world) {
  std::vector<FileCamera> cameras;
  for (const MeshDescription& mesh : world.meshes) {
    const std::string extension = LowerExtension(mesh.file);
    std::error_code error;  // a missing file is reported when the mesh is loaded
    const bool has_cameras = extension == ".gltf" || extension == ".glb";
    if (!has_cameras || !std::filesystem::is_regular_file(mesh.file, error)) continue;
    const MeshImport import = ImportMesh(mesh.file, world.folders, true);
    if (!import.problem.empty()) throw std::runtime_error(mesh.file.string() + ": " + import.problem);
    glm::dmat4 world_from_file = glm::mat4_cast(mesh.orientation);
    for (int c = 0; c < 3; ++c) world_from_file[c] *= mesh.scale * mesh.stretch[c];
    world_from_file[3] = glm::dvec4(mesh.position, 1);
    for (const ImportedCamera& in : import.cameras) {
      const glm::dmat4 m = world_from_file * in.transform;
      const glm::dvec3 forward = -glm::normalize(glm::dvec3(m[2])),
                       right = glm::normalize(glm::cross(forward, glm::dvec3(m[1])));
      const glm::dquat q = glm::quat_cast(glm::dmat3(right, glm::cross(forward, right), forward));
      cameras.push_back({mesh.name + "/" + in.name, {glm::dvec3(m[3]), glm::normalize(q)}, in.yfov_rad, in.aspect});
    }
  }
  return cameras;
}

}  // namespace

const FileCamera& FileCameras::At(const std::string& name) {
  if (!cameras_) cameras_ = CamerasOf(world_);
  std::vector<const FileCamera*> found;
  std::string all;
  for (const FileCamera& camera : *cameras_) {
    all += (all.empty() ? "" : ", ") + camera.name;
    if (camera.name == name || camera.name.ends_with("/" + name)) found.push_back(&camera);
  }
  if (found.size() == 1) return *found[0];
  throw std::runtime_error((found.empty() ? "there is no camera '" : "there is more than one camera '") + name +
                           "'; there are " + (all.empty() ? "none in glTF files of 'world.meshes'" : all));
}

void SetIntrinsics(const FileCamera& from, CameraParams& p) {
  const auto fail = [&](const std::string& what) { throw std::runtime_error("the camera " + from.name + " " + what); };
  if (from.yfov_rad == 0) fail("is orthographic, which is not rendered");
  if (!(from.yfov_rad > 0 && from.yfov_rad < std::numbers::pi)) fail("has a yfov of " + std::to_string(from.yfov_rad));
  if (!(from.aspect > 0) && p.height == 0) fail("states no aspectRatio: 'height' is missing");
  const double aspect = from.aspect > 0 ? from.aspect : static_cast<double>(p.width) / p.height;
  const int height = static_cast<int>(std::lround(p.width / aspect));
  if (p.height == 0) p.height = height;
  if (p.height != height && p.width != std::lround(p.height * aspect))
    fail("has " + std::to_string(height) + " rows for a width of " + std::to_string(p.width));
  p.fx = 0.5 * p.width / (aspect * std::tan(0.5 * from.yfov_rad));
  p.fy = 0.5 * p.height / std::tan(0.5 * from.yfov_rad);
  p.cx = 0.5 * (p.width - 1);
  p.cy = 0.5 * (p.height - 1);
}

}  // namespace sim
