#include "sim/world/file_cameras.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/world/mesh_import.h"

namespace sim {

FileCamera CameraOf(const ImportedCamera& in, const MeshDescription& mesh) {
  glm::dmat4 world_from_file = glm::mat4_cast(mesh.orientation);
  for (int c = 0; c < 3; ++c) world_from_file[c] *= mesh.scale * mesh.stretch[c];
  world_from_file[3] = glm::dvec4(mesh.position, 1);
  const glm::dmat4 m = world_from_file * in.transform;
  const glm::dvec3 forward = -glm::normalize(glm::dvec3(m[2])),
                   right = glm::normalize(glm::cross(forward, glm::dvec3(m[1])));
  const glm::dmat3 R(right, glm::cross(forward, right), forward);
  return {mesh.name, in.name, {glm::dvec3(m[3]), glm::normalize(glm::quat_cast(R))}, in.yfov_rad, in.aspect};
}

void FileCameras::Read() {
  is_read_ = true;
  for (const MeshDescription& mesh : world_.meshes) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(mesh.file, error)) continue;  // is said when the mesh is loaded
    const MeshImport import = ImportCameras(mesh.file, world_.folders);
    if (!import.problem.empty()) problems_ += "; " + mesh.file.string() + ": " + import.problem;
    for (const ImportedCamera& camera : import.cameras) cameras_.push_back(CameraOf(camera, mesh));
  }
}

const FileCamera& FileCameras::At(const std::string& name) {
  if (!is_read_) Read();
  const FileCamera* found = nullptr;
  std::size_t count = 0;
  std::string all;
  for (const FileCamera& camera : cameras_) {
    const std::string whole = camera.mesh + "/" + camera.name;
    all += (all.empty() ? "" : ", ") + whole;
    if (name != whole && name != camera.name) continue;
    found = &camera;
    ++count;
  }
  if (count == 1) return *found;
  throw std::runtime_error(count > 1     ? "more than one camera is called '" + name + "'; there are " + all
                           : all.empty() ? "no glTF file of 'world.meshes' has a camera" + problems_
                                         : "there is no camera '" + name + "'; there are " + all + problems_);
}

void SetIntrinsics(const FileCamera& from, CameraParams& p) {
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error("the camera '" + from.name + "' " + what);
  };
  if (from.yfov_rad == 0) fail("is orthographic, which is not rendered");
  if (!(from.yfov_rad > 0 && from.yfov_rad < std::numbers::pi) || !(from.aspect >= 0) || !std::isfinite(from.aspect))
    fail("has the yfov " + std::to_string(from.yfov_rad) + " and the aspectRatio " + std::to_string(from.aspect));
  if ((p.width == 0 && p.height == 0) || (from.aspect == 0 && (p.width == 0 || p.height == 0)))
    fail(from.aspect == 0 ? "states no aspectRatio: it needs 'width' and 'height'" : "needs 'width' or 'height'");
  const double aspect = from.aspect > 0 ? from.aspect : static_cast<double>(p.width) / p.height;
  if (p.width == 0) p.width = static_cast<int>(std::lround(p.height * aspect));
  const int height = static_cast<int>(std::lround(p.width / aspect));
  if (p.height == 0) p.height = height;
  if (p.height != height && p.width != std::lround(p.height * aspect))
    fail("has the aspectRatio " + std::to_string(aspect) + ": " + std::to_string(p.width) + " x " +
         std::to_string(height) + " fits, not " + std::to_string(p.width) + " x " + std::to_string(p.height));
  p.fy = 0.5 * p.height / std::tan(0.5 * from.yfov_rad);
  p.fx = 0.5 * p.width / (aspect * std::tan(0.5 * from.yfov_rad));
  p.cx = 0.5 * (p.width - 1);
  p.cy = 0.5 * (p.height - 1);
}

}  // namespace sim
