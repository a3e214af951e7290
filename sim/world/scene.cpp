#include "sim/world/scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <iterator>
#include <utility>

#include "sim/world/mesh_loader.h"
#include "tools/base/text.h"

namespace sim {
namespace {

bool IsFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool IsLight(const glm::dvec3& v) { return IsFinite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

// Problem of a light; empty: none.
struct LightProblem {
  std::string operator()(const AmbientLight& l) const { return Power(l.radiance, "radiance"); }
  std::string operator()(const SunLight& l) const {
    if (!IsFinite(l.direction) || !(glm::length(l.direction) > 0)) return "the sun's direction is zero or not finite";
    return Power(l.irradiance, "irradiance");
  }
  std::string operator()(const PointLight& l) const {
    if (!IsFinite(l.position)) return "the position of a point light is not finite";
    return Power(l.intensity, "intensity");
  }
  std::string operator()(const RectLight& l) const {
    const double area = glm::length(glm::cross(l.side_u, l.side_v));
    if (!IsFinite(l.corner) || !(area > 0) || !std::isfinite(area))
      return "a rectangular light has no area or is not finite";
    return Power(l.radiance, "radiance");
  }
  static std::string Power(const glm::dvec3& power, const std::string& name) {
    return IsLight(power) ? "" : name + " is negative or not finite";
  }
};

}  // namespace

SceneError::SceneError(std::vector<std::string> problems)
    : std::runtime_error(base::Join(problems, "\n")), problems_(std::move(problems)) {}

Scene LoadScene(const WorldDescription& description) {
  Scene scene;
  WorldLoading loading{scene, description.folders, description.cache_folders, description.missing_textures};
  std::vector<std::string>& problems = loading.problems;
  for (std::size_t i = 0; i < description.lights.size(); ++i) {
    const std::string problem = std::visit(LightProblem{}, description.lights[i]);
    if (!problem.empty()) problems.push_back("world.lights[" + std::to_string(i) + "]: " + problem);
  }
  if (!IsLight(description.background)) problems.push_back("world.background: negative or not finite");

  if (description.sky) {
    if (!description.sky->file.empty()) scene.files.insert(description.sky->file);
    try {
      scene.sky = LoadSky(*description.sky);
    } catch (const std::runtime_error& problem) {
      problems.push_back(std::string(problem.what()) + " (the sky)");
    }
  }

  const auto append = [&](const MeshDescription& mesh) {
    const glm::dquat& q = mesh.orientation;
    if (!IsFinite(mesh.position) || !(mesh.scale > 0) || !std::isfinite(mesh.scale) ||
        !(std::abs(glm::dot(q, q) - 1.0) < 1e-6)) {
      problems.push_back(mesh.file.string() +
                         ": its position, orientation (unit) or scale (> 0) in the world is unusable");
      return;
    }
    AppendMeshFile(mesh, loading);
  };
  for (std::size_t k = 0; k < description.meshes.size(); ++k) {
    append(description.meshes[k]);
    scene.mesh_entries.resize(scene.meshes.size(), k);
  }
  for (const ObjectDescription& object : description.objects) {
    const auto first = static_cast<std::ptrdiff_t>(scene.meshes.size());
    append(object.mesh);
    const auto begin = scene.meshes.begin() + first;
    scene.objects.push_back(
        {object.mesh.name, {std::move_iterator(begin), std::move_iterator(scene.meshes.end())}, nullptr});
    scene.meshes.erase(begin, scene.meshes.end());
  }
  LoadPictures(loading);
  if (!problems.empty()) throw SceneError(std::move(problems));
  scene.warnings = loading.warnings.Summed();
  scene.lights = description.lights;
  scene.background = description.background;
  return scene;
}

bool IsCutOut(const Scene& scene, const Material& m) {
  if (!(m.alpha_cutoff > 0)) return false;
  return m.alpha < m.alpha_cutoff ||
         (m.texture >= 0 && scene.textures[static_cast<std::size_t>(m.texture)].has_alpha());
}

}  // namespace sim
