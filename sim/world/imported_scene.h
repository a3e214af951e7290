// Content of a mesh file, sent from its reader in the importer's process to the loader. Private to sim/world.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/mat3x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim/world/uv_wrap.h"

namespace sim {

// Texture coordinates of a picture: a set of the mesh's, and the transform applied to it (v down):
// uv' = transform * (u, v, 1).
struct UvChoice {
  unsigned channel = 0;
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};                       // columns: of u, of v, and of 1
  std::array<UvWrap, 2> wrap = {UvWrap::repeat, UvWrap::repeat};  // along u and v
};

struct ImportedMap {
  std::string picture{};  // a file, as the mesh names it; empty: none
  int embedded = -1;      // in ImportedScene::pictures; -1: it is not in the mesh file
  UvChoice uv{};
};

struct ImportedMaterial {
  std::string name;
  std::string folder{};  // that its textures are named from, relative to the mesh's
  glm::vec4 base_color{1.0f};
  glm::vec3 emission{0.0f};
  float metallic = 0.0f, roughness = 1.0f, normal_scale = 1.0f, opacity = 1.0f;
  std::string alpha_mode{};  // glTF's; empty: the file has none
  float alpha_cutoff = 0.5f;
  int unlit = 0, has_bumps = 0;
  ImportedMap color_map{}, opacity_map{}, emission_map{}, normal_map{}, gloss_map{};
};

// A file, or where it has a height texels b, g, r, a.
struct ImportedPicture {
  unsigned width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

// Per-vertex arrays are empty or as long as positions. Texture coordinates: v up.
struct ImportedMesh {
  std::string name;
  unsigned material = 0;
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> colors;
  std::vector<std::vector<glm::vec2>> uvs;  // by set
  std::vector<glm::uvec3> triangles;
};

struct ImportedNode {
  int parent = -1;            // which comes before it; -1: none
  glm::mat4 transform{1.0f};  // parent from node
  std::vector<unsigned> meshes;
};

struct ImportedCamera {
  std::string name;           // of its node; else its own
  glm::dmat4 transform{1.0};  // file from camera: x right, y up, -z forward
  double yfov_rad = 0;        // 0: it is orthographic
  double aspect = 0;          // width / height; 0: not stated
};

struct ImportedScene {
  std::vector<ImportedNode> nodes;
  std::vector<ImportedMesh> meshes;
  std::vector<ImportedMaterial> materials;
  std::vector<ImportedPicture> pictures;
};

struct MeshImport {
  ImportedScene scene;
  std::string problem;                    // why there is none; empty: there is
  std::set<std::filesystem::path> files;  // that the importer tried to open
  std::set<std::string> missing;          // those that could not be opened, without their folder
  std::vector<std::string> warnings;
  glm::dvec3 origin{0.0};  // of the scene's coordinates, in the file's
  std::vector<ImportedCamera> cameras{};
};

// Counts of a whole file, and their limits.
struct MeshCounts {
  std::uint64_t vertices = 0, corners = 0, nodes = 0, meshes = 0, materials = 0, picture_bytes = 0;
  // The limit that is exceeded; empty: none.
  std::string Problem() const;
};
MeshCounts CountsOf(const ImportedScene& scene);

using ByteSink = std::function<void(std::span<const std::uint8_t>)>;
void WriteBytes(const MeshImport& import, const ByteSink& sink);
// Throws std::runtime_error for truncated bytes and invalid indices.
MeshImport ImportFromBytes(std::span<const std::uint8_t> bytes);

}  // namespace sim
