// Meshes of triangles from polygons. Private to sim/world.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sim/world/imported_scene.h"

namespace sim {

// Arrays that polygons index, and their corners: indices of position, texture coordinate, normal and colour; -1: none.
struct PolygonPools {
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> colors;
};
using Corner = std::array<std::int32_t, 4>;
struct Polygons {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> sizes;  // of each, in corners
};
// Description of an index out of range; empty: none.
std::string IndexProblem(const Polygons& polygons, const PolygonPools& pools);
// Triangles with a vertex for each distinct corner, at positions less `origin`; of texture coordinates, normals and
// colours those that the first corner has. Indices must be valid.
void AppendPolygons(const Polygons& polygons, const PolygonPools& pools, const glm::dvec3& origin, ImportedMesh& mesh);

// Colours beyond 1 are taken as 0 ... 255, or as 0 ... 65535 where they go beyond that, with a warning.
void ScaleColors(PolygonPools& pools, std::vector<std::string>& warnings);

// One node that holds all meshes.
ImportedNode NodeOfAll(const std::vector<ImportedMesh>& meshes);

// Triangles of a polygon with any number of corners, convex or not: indices into them.
// Source: G. H. Meisters, "Polygons have ears", Am. Math. Monthly 82 (1975), in the plane of the polygon's area vector.
std::vector<std::array<unsigned, 3>> Triangulate(std::span<const glm::dvec3> corners);

// Box about positions, empty at first.
struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  void Add(const glm::dvec3& position);
  void Add(const Polygons& polygons, const PolygonPools& pools);  // what they use
};

// Offset to subtract from coordinates too large for floats (UTM, for example): 0, or near their middle.
glm::dvec3 OriginFor(const Box& box);
glm::dvec3 OriginFor(std::span<const glm::dvec3> positions);

}  // namespace sim
