#include "sim/world/gltf_vertices.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>

namespace sim {

void PoseVertices(std::span<const JointWeights> weights, std::span<const glm::dmat4> joints, ImportedMesh& mesh) {
  std::vector<glm::dmat4> sums(mesh.positions.size(), glm::dmat4(0));
  for (const JointWeights& set : weights) {
    for (std::size_t k = 0; k < 4 * set.joints.count; ++k) {
      const float joint = set.joints.at(k / 4, k % 4), weight = set.weights.at(k / 4, k % 4);
      if (weight == 0) continue;
      if (!(joint >= 0 && joint < static_cast<float>(joints.size())))
        throw std::runtime_error("a vertex names a joint that does not exist");
      sums[k / 4] += static_cast<double>(weight) * joints[static_cast<std::size_t>(joint)];
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::dmat4 posed = sums[i][3][3] > 0 ? sums[i] / sums[i][3][3] : joints[0];  // the weights' sum is 1 or 0
    mesh.positions[i] = posed * glm::dvec4(mesh.positions[i], 1);
    if (!mesh.normals.empty())
      mesh.normals[i] = glm::transpose(glm::inverse(glm::dmat3(posed))) * glm::dvec3(mesh.normals[i]);
  }
}

bool ContradictsUvs(const GltfTable& tangents, const ImportedMesh& mesh, const UvChoice& choice) {
  const std::vector<glm::vec2>& uvs = mesh.uvs[choice.channel];
  std::size_t against = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    if (std::max({t.x, t.y, t.z}) >= uvs.size()) continue;
    const glm::dmat3x2 transform = choice.transform;
    const auto at = [&](unsigned i) { return transform * glm::dvec3(uvs[i].x, 1 - uvs[i].y, 1); };
    const glm::dvec2 a = at(t.y) - at(t.x), b = at(t.z) - at(t.x);
    const glm::dvec3 p = mesh.positions[t.y] - mesh.positions[t.x], q = mesh.positions[t.z] - mesh.positions[t.x];
    const double area = b.x * a.y - a.x * b.y;  // of the texture, v up
    const glm::dvec3 own = (q * a.y - p * b.y) * (area < 0 ? -1.0 : 1.0);
    glm::dvec4 given(0);
    for (const unsigned i : {t.x, t.y, t.z})
      given += glm::dvec4(tangents.at(i, 0), tangents.at(i, 1), tangents.at(i, 2), tangents.at(i, 3));
    const double along = glm::dot(own, glm::dvec3(given));
    if (along < 0.5 * glm::length(own) * glm::length(glm::dvec3(given)) || given.w * area < 0) ++against;
  }
  return 2 * against > mesh.triangles.size();
}

}  // namespace sim
