#include "sim/world/coincident_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <tuple>

namespace sim {
namespace {

struct Place {
  std::uint64_t key;
  std::uint32_t mesh, triangle;
};

std::uint64_t Mixed(std::uint64_t x) {  // the finaliser of SplitMix64
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

std::uint64_t KeyOf(const glm::vec3& p) {
  const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x + 0.0F)}; };  // -0 is 0
  return Mixed(bits(p.x) | bits(p.y) << 32) + Mixed(~bits(p.z));
}

// The same for each order of the corners.
std::uint64_t KeyOf(const Mesh& mesh, const glm::uvec3& t) {
  return Mixed(KeyOf(mesh.positions[t.x])) + Mixed(KeyOf(mesh.positions[t.y])) + Mixed(KeyOf(mesh.positions[t.z]));
}

// The corners in their cyclic order, from the least one on.
std::array<std::array<float, 3>, 3> Corners(const Mesh& mesh, const glm::uvec3& t) {
  std::array<std::array<float, 3>, 3> corners;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& p = mesh.positions[t[i]];
    corners[static_cast<std::size_t>(i)] = {p.x, p.y, p.z};
  }
  std::ranges::rotate(corners, std::ranges::min_element(corners));
  return corners;
}

// The marked triangles of a mesh as a mesh, with their vertices; the others stay.
Mesh Taken(Mesh& mesh, const std::vector<bool>& is_marked) {
  Mesh taken;
  taken.name = mesh.name;
  taken.material = mesh.material;
  taken.one_sided = true;
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> place(mesh.positions.size(), kNone);
  const auto take = [&](std::uint32_t v) {
    if (place[v] != kNone) return place[v];
    place[v] = static_cast<std::uint32_t>(taken.positions.size());
    taken.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) taken.normals.push_back(mesh.normals[v]);
    if (!mesh.uvs.empty()) taken.uvs.push_back(mesh.uvs[v]);
    if (!mesh.colors.empty()) taken.colors.push_back(mesh.colors[v]);
    return place[v];
  };
  std::vector<glm::uvec3> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    if (is_marked[i])
      taken.triangles.emplace_back(take(t.x), take(t.y), take(t.z));
    else
      kept.push_back(t);
  }
  mesh.triangles = std::move(kept);
  return taken;
}

}  // namespace

void SeparateCoincidentFaces(std::vector<Mesh>& meshes, std::size_t first) {
  std::size_t triangles = 0;
  for (std::size_t m = first; m < meshes.size(); ++m) triangles += meshes[m].triangles.size();
  if (triangles < 2) return;
  // Two sets of bits, by the key's low bits, which find nearly all triangles without a twin in two passes.
  const std::uint64_t mask = std::bit_ceil(16 * triangles) - 1;
  std::vector<bool> is_met(mask + 1), is_met_again(mask + 1);
  for (std::size_t m = first; m < meshes.size(); ++m) {
    for (const glm::uvec3& t : meshes[m].triangles) {
      const std::uint64_t bit = KeyOf(meshes[m], t) & mask;
      is_met_again[bit] = is_met[bit];
      is_met[bit] = true;
    }
  }
  std::vector<Place> places;
  for (std::size_t m = first; m < meshes.size(); ++m) {
    for (std::size_t i = 0; i < meshes[m].triangles.size(); ++i) {
      const std::uint64_t key = KeyOf(meshes[m], meshes[m].triangles[i]);
      if (is_met_again[key & mask])
        places.push_back({key, static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(i)});
    }
  }
  std::ranges::sort(places, {}, [](const Place& p) { return std::tuple(p.key, p.mesh, p.triangle); });
  std::vector<std::vector<bool>> is_marked(meshes.size());
  const auto mark = [&](const Place& p) {
    is_marked[p.mesh].resize(meshes[p.mesh].triangles.size());
    is_marked[p.mesh][p.triangle] = true;
  };
  const auto corners = [&](const Place& p) { return Corners(meshes[p.mesh], meshes[p.mesh].triangles[p.triangle]); };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto own = corners(places[i]);
    const std::array turned = {own[0], own[2], own[1]};
    constexpr std::size_t kMost = 8;  // that coincide
    for (std::size_t k = i + 1; k < std::min(i + kMost, places.size()) && places[k].key == places[i].key; ++k) {
      if (corners(places[k]) != turned) continue;
      mark(places[i]);
      mark(places[k]);
    }
  }
  for (std::size_t m = first; m < is_marked.size(); ++m) {
    if (is_marked[m].empty()) continue;
    if (std::ranges::count(is_marked[m], false) == 0)
      meshes[m].one_sided = true;
    else
      meshes.push_back(Taken(meshes[m], is_marked[m]));
  }
}

}  // namespace sim
