#include "sim/world/labels.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <span>

namespace sim {

std::uint32_t Labels::ClassId(const Instance& instance) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(classes, instance.category) - classes.begin()) + 1;
}

Labels LabelsOf(const Scene& scene, const WorldDescription& description) {
  Labels labels;
  const auto add = [&](const MeshDescription& of, const std::string& entry, int object, std::span<const Mesh> meshes) {
    labels.of_mesh.resize(labels.of_mesh.size() + meshes.size(), static_cast<std::uint32_t>(labels.instances.size()));
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Mesh& mesh : meshes) {
      for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
          const glm::dvec3 X = glm::conjugate(of.orientation) * glm::dvec3(mesh.positions[triangle[corner]]);
          low = glm::min(low, X);
          high = glm::max(high, X);
        }
      }
    }
    const Pose box{of.orientation * (0.5 * (low + high)), of.orientation};
    labels.instances.push_back({of.name, of.category, entry, object, box, high - low});
    labels.classes.push_back(of.category);
  };
  for (std::size_t k = 0; k < description.meshes.size(); ++k) {
    const auto [first, last] = std::equal_range(scene.mesh_entries.begin(), scene.mesh_entries.end(), k);
    add(description.meshes[k], "world.meshes." + std::to_string(k), -1,
        std::span(scene.meshes)
            .subspan(static_cast<std::size_t>(first - scene.mesh_entries.begin()),
                     static_cast<std::size_t>(last - first)));
  }
  for (std::size_t k = 0, lamps = 0; k < scene.lights.size(); ++k) {
    const auto* lamp = std::get_if<RectLight>(&scene.lights[k]);
    if (lamp == nullptr || !lamp->visible) continue;
    MeshDescription of;
    of.category = "lamp";
    of.name = ++lamps > 1 ? "lamp_" + std::to_string(lamps) : "lamp";
    Mesh mesh;
    for (const glm::dvec3& side : {glm::dvec3(0), lamp->side_u, lamp->side_v, lamp->side_u + lamp->side_v})
      mesh.positions.emplace_back(lamp->corner + side);
    mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
    add(of, "world.lights." + std::to_string(k), -1, {&mesh, 1});
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
    add(description.objects[k].mesh, "world.objects." + std::to_string(k), static_cast<int>(k),
        scene.objects[k].meshes);
  std::ranges::sort(labels.classes);
  labels.classes.erase(std::unique(labels.classes.begin(), labels.classes.end()), labels.classes.end());
  return labels;
}

}  // namespace sim
