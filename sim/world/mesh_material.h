// Materials and textures of a mesh file. Private to sim/world.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/mesh_loader.h"
#include "sim/world/scene.h"

namespace sim {

// Which texture coordinates a material's pictures want: a channel of the file, and what is applied to it (v down):
// uv' = transform * (u, v, 1).
struct UvChoice {
  unsigned channel = 0;
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};  // columns: of u, of v, and of 1
  bool operator==(const UvChoice&) const = default;
};

struct MeshMaterial {
  int index = -1;  // in Scene::materials
  UvChoice uv;
};

class MeshMaterialReader {
 public:
  MeshMaterialReader(const std::filesystem::path& file, const aiScene& from, Scene& scene, TextureCache& textures,
                     std::vector<std::string>& problems);

  // Factors on the emission of the file's materials; none: 1.
  void SetEmissionStrengths(std::vector<float> strengths) { strengths_ = std::move(strengths); }

  // Adds the file's material to the scene when it is asked for the first time.
  const MeshMaterial& Material(unsigned index);

 private:
  MeshMaterial Read(const aiMaterial& in, float emission_strength);
  void ReadAlpha(const aiMaterial& in, sim::Material& material);
  int ReadTexture(const aiMaterial& in, aiTextureType type, const char* what, Texture::Content content, bool with_alpha,
                  const std::string& name, std::vector<UvChoice>& uvs);
  UvChoice ReadUvChoice(const aiMaterial& in, aiTextureType type, const std::string& label);
  int TextureIndex(const std::string& name, const std::string& material, Texture::Content content, bool with_alpha);
  void Warn(const std::string& what) { scene_.warnings.push_back(file_.string() + ": " + what); }

  std::filesystem::path file_;
  const aiScene& ai_;
  bool is_gltf_;
  std::vector<MeshMaterial> materials_;  // by the file's index; index -1: not used yet
  std::vector<float> strengths_;
  Scene& scene_;
  TextureCache& textures_;
  std::vector<std::string>& problems_;
};

}  // namespace sim
