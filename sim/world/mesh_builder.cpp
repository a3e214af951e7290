#include "sim/world/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>
#include <unordered_map>

namespace sim {
namespace {

// Twice the signed area.
double Cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct HashCorner {
  std::size_t operator()(const Corner& c) const {
    std::uint64_t hash = 0;
    for (const std::int32_t i : c) hash = (hash ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
  }
};

}  // namespace

std::string IndexProblem(const Polygons& polygons, const PolygonPools& pools) {
  const std::array<std::size_t, 4> counts = {pools.positions.size(), pools.uvs.size(), pools.normals.size(),
                                             pools.colors.size()};
  constexpr const char* kNames[] = {"vertex ", "texture coordinate ", "normal ", "colour "};
  for (const Corner& corner : polygons.corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (corner[i] >= static_cast<std::int64_t>(counts[i]) || corner[i] < (i == 0 ? 0 : -1))
        return "a face names " + std::string(kNames[i]) + std::to_string(std::int64_t{corner[i]} + 1) + " of " +
               std::to_string(counts[i]);
    }
  }
  return "";
}

void AppendPolygons(const Polygons& polygons, const PolygonPools& pools, const glm::dvec3& origin, ImportedMesh& mesh) {
  std::unordered_map<Corner, unsigned, HashCorner> vertex_of;
  vertex_of.reserve(polygons.corners.size());
  const Corner has = polygons.corners.empty() ? Corner{} : polygons.corners[0];
  if (has[1] >= 0) mesh.uvs.resize(1);
  std::vector<glm::dvec3> outline;
  std::vector<unsigned> vertices;
  std::size_t first = 0;
  for (const std::uint32_t size : polygons.sizes) {
    outline.clear();
    vertices.clear();
    for (std::size_t i = first; i < first + size; ++i) {
      const Corner& corner = polygons.corners[i];
      const auto of = [&](std::size_t pool) { return static_cast<std::size_t>(std::max(corner[pool], 0)); };
      const auto [vertex, is_new] = vertex_of.try_emplace(corner, static_cast<unsigned>(mesh.positions.size()));
      outline.push_back(pools.positions[of(0)]);
      vertices.push_back(vertex->second);
      if (!is_new) continue;
      mesh.positions.emplace_back(pools.positions[of(0)] - origin);
      if (has[1] >= 0) mesh.uvs[0].push_back(pools.uvs[of(1)]);
      if (has[2] >= 0) mesh.normals.push_back(pools.normals[of(2)]);
      if (has[3] >= 0) mesh.colors.push_back(pools.colors[of(3)]);
    }
    for (const auto& [a, b, c] : Triangulate(outline))
      mesh.triangles.emplace_back(vertices[a], vertices[b], vertices[c]);
    first += size;
  }
}

void ScaleColors(PolygonPools& pools, std::vector<std::string>& warnings) {
  float largest = 0;
  for (const glm::vec4& c : pools.colors) largest = std::max({largest, c.r, c.g, c.b});
  constexpr float kRounded = 1.001F;  // of 1, after sums of colours
  if (!(largest > kRounded)) return;
  const float white = largest > 255 ? 65535.0f : 255.0f;
  warnings.push_back("vertex colours go beyond 1: they are taken as 0 ... " + std::to_string(static_cast<int>(white)));
  for (glm::vec4& c : pools.colors) c = glm::vec4(c.r / white, c.g / white, c.b / white, 1);
}

ImportedNode NodeOfAll(const std::vector<ImportedMesh>& meshes) {
  ImportedNode node;
  node.meshes.resize(meshes.size());
  std::iota(node.meshes.begin(), node.meshes.end(), 0u);
  return node;
}

std::vector<std::array<unsigned, 3>> Triangulate(std::span<const glm::dvec3> corners) {
  const auto n = static_cast<unsigned>(corners.size());
  if (n < 3) return {};
  if (n == 3) return {{0, 1, 2}};
  glm::dvec3 area(0);
  for (unsigned i = 1; i + 1 < n; ++i) area += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  const glm::dvec3 size = glm::abs(area);
  const int drop = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  const double side = area[drop] < 0 ? -1 : 1;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& x : corners) flat.emplace_back(x[u], side * x[v]);  // counter-clockwise
  std::vector<unsigned> left(n);
  std::iota(left.begin(), left.end(), 0u);
  std::vector<std::array<unsigned, 3>> triangles;
  while (left.size() > 3) {
    std::size_t ear = left.size();
    for (std::size_t k = 1; k <= left.size() && ear == left.size(); ++k) {  // so that a convex one is a fan
      const std::size_t i = k % left.size();
      const unsigned a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
      if (!(Cross(flat[a], flat[b], flat[c]) > 0)) continue;
      const bool is_empty = std::ranges::none_of(left, [&](unsigned other) {
        const glm::dvec2& p = flat[other];
        return p != flat[a] && p != flat[b] && p != flat[c] && Cross(flat[a], flat[b], p) >= 0 &&
               Cross(flat[b], flat[c], p) >= 0 && Cross(flat[c], flat[a], p) >= 0;
      });
      if (is_empty) ear = i;
    }
    if (ear == left.size()) ear = 1;  // self-intersecting or without area: as a fan
    triangles.push_back({left[(ear + left.size() - 1) % left.size()], left[ear], left[(ear + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

void Box::Add(const glm::dvec3& position) { low = glm::min(low, position), high = glm::max(high, position); }

void Box::Add(const Polygons& polygons, const PolygonPools& pools) {
  for (const Corner& corner : polygons.corners) Add(pools.positions[static_cast<std::size_t>(corner[0])]);
}

glm::dvec3 OriginFor(std::span<const glm::dvec3> positions) {
  Box box;
  for (const glm::dvec3& x : positions) box.Add(x);
  return OriginFor(box);
}

glm::dvec3 OriginFor(const Box& box) {
  const auto& [low, high] = box;
  const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high)), middle = 0.5 * (low + high);
  const double largest = std::max({far.x, far.y, far.z});
  const bool is_fine = !(0x1p-24 * largest > 1e-6 * glm::length(high - low)) || !std::isfinite(largest);
  return is_fine ? glm::dvec3(0) : glm::round(middle);
}

}  // namespace sim
