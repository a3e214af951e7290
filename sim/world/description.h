// Parameters of a world. No file has been read yet.
#pragma once

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/description.h"
#include "sim/world/light.h"
#include "sim/world/sky.h"

namespace sim {

// Replacement of a material of the file.
struct MaterialDescription {
  std::string name;                   // of the file's material
  std::optional<glm::dvec3> color{};  // linear
  std::filesystem::path texture{};    // times the colour; empty: none
};
// But for name and file.
template <class V>
void Visit(V& v, MaterialDescription& p) {
  v("color", p.color, {kOfLight, "albedo (linear) in its place; with texture: a factor on it"});
}

// Placement of a mesh file in the world: X_W = position + R(orientation) * scale * diag(stretch) * X_file.
struct MeshDescription {
  std::filesystem::path file;  // glTF, GLB, OBJ, PLY, and whatever else assimp reads
  glm::dvec3 position{0.0};    // [m]
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;    // metres per unit of the file, > 0
  std::string name;      // no other mesh or object of the world has it
  std::string category;  // `class` of a scenario
  glm::dvec3 stretch{1.0};
  std::optional<glm::dvec3> color{};  // linear; with it or a texture, one material stands for all of the file's
  std::filesystem::path texture{};    // times the colour; empty: none
  std::vector<MaterialDescription> materials{};
  std::string place{};  // FILE:LINE:COLUMN in the scenario; empty: none
};
// But for files, name, class, materials and place.
template <class V>
void Visit(V& v, MeshDescription& p) {
  v("position", p.position, {Unit::length, settings::Range{-1e8, 1e8}, "of the file's origin in W"});
  v("orientation", p.orientation, {"of the file in W: x, y, z, w"});
  v("scale", p.scale, {Range{1e-9, 1e9}, "metres per unit of the file"});
  v("stretch", p.stretch, {Range{-1e9, 1e9}, "factors along the file's axes, beside the scale"});
  v("color", p.color, {kOfLight, "albedo (linear) instead of the file's materials; with texture: a factor on it"});
}

// A mesh file that moves as a rigid body. It is placed in the object's own frame O as a mesh is in the world.
struct ObjectDescription {
  MeshDescription mesh;      // its name is that of the object's file of poses
  MotionDescription motion;  // T_WO
};

// Treatment of missing textures: an error, or grey (a warning).
enum class MissingTextures { error, grey };

struct WorldDescription {
  std::vector<std::filesystem::path>
      folders;  // that meshes may read from, beside their own: of the scenario, of textures
  std::vector<std::filesystem::path> cache_folders;  // where decoded textures are kept; none: nowhere
  MissingTextures missing_textures = MissingTextures::error;
  std::vector<MeshDescription> meshes;
  std::vector<ObjectDescription> objects;
  std::vector<Light> lights;
  glm::dvec3 background{0.0};  // linear radiance of a ray that meets no surface; unused where there is a sky
  std::optional<SkyDescription> sky;
};
// But for meshes, objects and lights.
template <class V>
void Visit(V& v, WorldDescription& p) {
  v("background", p.background, {kOfLight, "radiance where nothing is and there is no sky"});
  v("missing_textures", p.missing_textures, {{"error", MissingTextures::error}, {"grey", MissingTextures::grey}},
    "what a texture that is not there is");
}

}  // namespace sim
