// Scene: triangles in W, moving objects, materials, textures in linear light, light sources.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/motion/trajectory.h"
#include "sim/world/description.h"
#include "sim/world/light.h"
#include "sim/world/sky.h"
#include "sim/world/texture.h"

namespace sim {

// Albedo = base_color * vertex colour * texture; radiance = emission * emission texture + reflected light; each where
// present. Lambertian, or, in a renderer with reflections, glTF's metallic-roughness model.
struct Material {
  std::string name;
  glm::vec3 base_color{1.0f};  // linear
  glm::vec3 emission{0.0f};    // linear radiance
  int texture = -1;            // index in Scene::textures; -1: none
  int emission_texture = -1;
  int normal_map = -1;  // its content is Texture::Content::numbers
  float normal_scale = 1.0f;
  float metallic = 0.0f, roughness = 1.0f;
  int gloss_texture = -1;        // roughness times its green, metallic times its blue; its content is numbers
  bool lacks_gloss_map = false;  // the file has one that is not read
  bool Mirrors() const { return metallic > 0 || roughness < 1; }
  bool HasPicture() const { return texture >= 0 || emission_texture >= 0 || normal_map >= 0 || gloss_texture >= 0; }
  // The surface is there only where alpha * the texture's alpha reaches the cutoff; 0: everywhere.
  float alpha = 1.0f, alpha_cutoff = 0.0f;
};

// Per-vertex arrays are empty or as long as positions. Surfaces are two-sided: what is seen faces the viewer,
// but for those that are one_sided.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;  // in W [m], or in O
  std::vector<glm::vec3> normals;    // the same, unit; empty: flat
  std::vector<glm::vec2> uvs;     // (0, 0) = upper left corner of the texture's image, v down; repeats outside [0, 1)
  std::vector<glm::vec3> colors;  // linear
  std::vector<glm::uvec3> triangles;
  int material = 0;        // index in Scene::materials
  bool one_sided = false;  // seen from the front alone: a triangle turned the other way coincides with each
};

// A rigid body on its path: X_W = T_WO(t) X_O, T_WO(t) = motion->At(t).pose.
struct MovingObject {
  std::string name;
  std::vector<Mesh> meshes;  // in O
  std::shared_ptr<const Trajectory> motion;
};

struct Scene {
  std::vector<Mesh> meshes;               // that stand still
  std::vector<std::size_t> mesh_entries;  // of each: which of WorldDescription::meshes it is of
  std::vector<MovingObject> objects;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  glm::vec3 background{0.0f};  // where there is no sky
  std::optional<Sky> sky;
  std::vector<std::string> warnings;      // what was readable but is probably not meant
  std::set<std::filesystem::path> files;  // all that were looked for: meshes, materials, pictures
};

// Whether the alpha test cuts holes into surfaces of the material.
bool IsCutOut(const Scene& scene, const Material& material);

// what(): every problem that was found, one per line, each naming its file.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<std::string> problems);
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

// Reads all mesh files and their textures (beside the mesh file or embedded in it). Colour factors in files are taken
// as linear; vertex colours are linear in glTF (its specification) and sRGB-coded in the other formats. Throws
// SceneError with all problems of the world at once: a mesh that is missing, corrupt, without triangles, or with a
// coordinate that is not finite; a texture that is missing, truncated, not an image, or named by an absolute path or
// one that leaves the mesh file's folder; a light that is not finite or has no direction. A textured material on a mesh
// without texture coordinates is a warning; its base colour is used. Objects have no motion yet: it is made for the
// time span needed (sim/motion/trajectory.h).
Scene LoadScene(const WorldDescription& description);

}  // namespace sim
