// Meshes of triangles and materials as assimp keeps them, from the readers here to the loader. Private to sim/world.
#pragma once

#include <assimp/material.h>
#include <assimp/scene.h>

#include <array>
#include <cstdint>
#include <glm/mat3x2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sim {

// Keys of a material that assimp has none for: the transform of texture coordinates (six numbers, glm::mat3x2, v
// down), the folder that its textures are named from (relative to the mesh's), and whether it is unlit.
constexpr const char* kUvTransformKey = "$vobench.uv";
constexpr const char* kFolderKey = "$vobench.folder";
constexpr const char* kUnlitKey = "$vobench.unlit";

// Per-vertex arrays are empty or as long as positions. Texture coordinates: v up.
struct BuiltMesh {
  std::string name;
  unsigned material = 0;
  std::vector<aiVector3D> positions, normals;
  std::vector<aiColor4D> colors;
  std::vector<std::vector<aiVector3D>> uvs;  // by set
  std::vector<std::array<unsigned, 3>> triangles;
};

// What polygons name by index, and their corners: indices of position, texture coordinate, normal and colour; -1: none.
struct PolygonPools {
  std::vector<glm::dvec3> positions;
  std::vector<aiVector3D> uvs, normals;
  std::vector<aiColor4D> colors;
};
using Corner = std::array<std::int32_t, 4>;
struct Polygons {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> sizes;  // of each, in corners
};
// An index that is not in its pool, in words; empty: none.
std::string IndexProblem(const Polygons& polygons, const PolygonPools& pools);
// Triangles with a vertex for each different corner, at positions less `origin`; of texture coordinates, normals and
// colours those that the first corner has. Indices are good.
void AppendPolygons(const Polygons& polygons, const PolygonPools& pools, const glm::dvec3& origin, BuiltMesh& mesh);

aiMesh* ToAssimp(const BuiltMesh& mesh);

template <class T>
void SetList(T**& list, unsigned& count, const std::vector<T*>& values) {
  count = static_cast<unsigned>(values.size());
  list = values.empty() ? nullptr : new T*[values.size()];
  std::copy(values.begin(), values.end(), list);
}

// A scene of one node that has all meshes.
std::unique_ptr<aiScene> SceneOf(std::span<const BuiltMesh> meshes, const std::vector<aiMaterial*>& materials);

void SetText(aiMaterial& material, const std::string& text, const char* key, unsigned type = 0, unsigned index = 0);
void SetUvTransform(aiMaterial& material, aiTextureType type, const glm::dmat3x2& transform);

// Triangles of a polygon with any number of corners, convex or not: indices into them.
// Source: G. H. Meisters, "Polygons have ears", Am. Math. Monthly 82 (1975), in the plane of the polygon's area vector.
std::vector<std::array<unsigned, 3>> Triangulate(std::span<const glm::dvec3> corners);

// What is subtracted from coordinates that floats would be too coarse for (UTM, say): 0, or near their middle.
glm::dvec3 OriginFor(std::span<const glm::dvec3> positions);

}  // namespace sim
