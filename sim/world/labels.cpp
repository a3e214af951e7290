#include "sim/world/labels.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <set>
#include <span>

namespace sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The box along the axes q of points that are added one by one.
struct Extent {
  glm::dquat q{1, 0, 0, 0};
  glm::dvec3 low{kInfinity}, high{-kInfinity};

  void Add(const glm::dvec3& X) {
    const glm::dvec3 along = glm::conjugate(q) * X;
    low = glm::min(low, along);
    high = glm::max(high, along);
  }
  void Add(const Mesh& mesh) {
    for (const glm::uvec3& triangle : mesh.triangles) {
      for (int corner = 0; corner < 3; ++corner) Add(mesh.positions[triangle[corner]]);
    }
  }
  void Into(Instance& instance) const {
    instance.box = {q * (0.5 * (low + high)), q};
    instance.size = high - low;
  }
};

}  // namespace

std::uint32_t Labels::ClassId(const Instance& instance) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(classes, instance.category) - classes.begin()) + 1;
}

Labels LabelsOf(const Scene& scene, const WorldDescription& description) {
  Labels labels;
  const auto add = [&](std::string name, std::string category, const std::string& list, std::size_t k, int object,
                       const Extent& extent, std::size_t meshes) {
    labels.of_mesh.resize(labels.of_mesh.size() + meshes, static_cast<std::uint32_t>(labels.instances.size()));
    Instance& instance = labels.instances.emplace_back();
    instance = {std::move(name), std::move(category), "world." + list + "." + std::to_string(k), object, {}, {}};
    extent.Into(instance);
  };
  std::size_t mesh = 0;
  for (std::size_t k = 0; k < description.meshes.size(); ++k) {
    const MeshDescription& of = description.meshes[k];
    Extent extent{of.orientation};
    const std::size_t first = mesh;
    for (; mesh < scene.meshes.size() && scene.mesh_entries[mesh] == k; ++mesh) extent.Add(scene.meshes[mesh]);
    add(of.name, of.category, "meshes", k, -1, extent, mesh - first);
  }
  std::size_t lamps = 0;
  for (std::size_t k = 0; k < scene.lights.size(); ++k) {
    const auto* lamp = std::get_if<RectLight>(&scene.lights[k]);
    if (lamp == nullptr || !lamp->visible) continue;
    Extent extent;
    for (const glm::dvec3& side : {glm::dvec3(0), lamp->side_u, lamp->side_v, lamp->side_u + lamp->side_v})
      extent.Add(lamp->corner + side);
    const std::string number = ++lamps > 1 ? "_" + std::to_string(lamps) : "";
    add("lamp" + number, "lamp", "lights", k, -1, extent, 1);
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const MeshDescription& of = description.objects[k].mesh;
    Extent extent{of.orientation};
    for (const Mesh& part : scene.objects[k].meshes) extent.Add(part);
    add(of.name, of.category, "objects", k, static_cast<int>(k), extent, scene.objects[k].meshes.size());
  }
  std::set<std::string> classes;
  for (const Instance& instance : labels.instances) classes.insert(instance.category);
  labels.classes = {classes.begin(), classes.end()};
  return labels;
}

}  // namespace sim
