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

// A mesh file that is read, and where its content goes.
struct MeshFile {
  std::filesystem::path path;
  bool is_gltf;
  Scene& scene;
  TextureCache& textures;
  std::vector<std::string>& problems;

  void Warn(const std::string& what) const { scene.warnings.push_back(path.string() + ": " + what); }
  void Problem(const std::string& what) const { problems.push_back(path.string() + ": " + what); }
};

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
  // emission_strengths: factors on the emission of the file's materials; where there is none: 1.
  MeshMaterialReader(const MeshFile& file, const aiScene& from, std::vector<float> emission_strengths)
      : file_(file), ai_(from), strengths_(std::move(emission_strengths)), materials_(from.mNumMaterials) {}

  // Adds the file's material to the scene when it is asked for the first time.
  const MeshMaterial& Material(unsigned index);

 private:
  MeshMaterial Read(const aiMaterial& in, float emission_strength);
  void ReadAlpha(const aiMaterial& in, sim::Material& material);
  int ReadTexture(const aiMaterial& in, aiTextureType type, const char* what, Texture::Content content, bool with_alpha,
                  const std::string& name, std::vector<UvChoice>& uvs);
  UvChoice ReadUvChoice(const aiMaterial& in, aiTextureType type, const std::string& label);
  int TextureIndex(const std::string& name, const std::string& material, Texture::Content content, bool with_alpha);

  const MeshFile& file_;
  const aiScene& ai_;
  std::vector<float> strengths_;
  std::vector<MeshMaterial> materials_;  // by the file's index; index -1: not used yet
};

}  // namespace sim
