// Materials and textures of a mesh file. Private to sim/world.
#pragma once

#include <assimp/material.h>
#include <assimp/scene.h>

#include <array>
#include <filesystem>
#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/image_file.h"
#include "sim/world/mesh_loader.h"
#include "sim/world/scene.h"
#include "sim/world/uv_wrap.h"

namespace sim {

// A mesh file that is read, and where its content goes.
struct MeshFile {
  std::filesystem::path path;
  std::string extension;  // ".obj", say
  bool is_gltf;
  Scene& scene;
  WorldLoading& loading;

  // who: what differs from file to file; what: the same for all of a kind.
  void Warn(const std::string& who, const std::string& what) const {
    loading.warnings.Add(path.string() + ": " + who, what);
  }
  void Problem(const std::string& what) const { loading.problems.push_back(path.string() + ": " + what); }
};

// Which texture coordinates a material's pictures want: a channel of the file, and what is applied to it (v down):
// uv' = transform * (u, v, 1).
struct UvChoice {
  unsigned channel = 0;
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};                       // columns: of u, of v, and of 1
  std::array<UvWrap, 2> wrap = {UvWrap::repeat, UvWrap::repeat};  // along u and v
  bool IsSamePlace(const UvChoice& other) const { return channel == other.channel && transform == other.transform; }
};

struct MeshMaterial {
  int index = -1;  // in Scene::materials
  UvChoice uv;
};

class MeshMaterialReader {
 public:
  MeshMaterialReader(const MeshFile& file, const aiScene& from)
      : file_(file), ai_(from), materials_(from.mNumMaterials) {}

  // Adds the file's material to the scene when it is asked for the first time.
  const MeshMaterial& Material(unsigned index);

 private:
  // A picture's use in a material.
  struct Use {
    aiTextureType type;
    const char* what;  // "normal ", say
    Texture::Content content = Texture::Content::color;
    bool with_alpha = false;
    std::string mask{};  // the picture of its opacity
  };

  MeshMaterial Read(const aiMaterial& in);
  void ReadAlpha(const aiMaterial& in, sim::Material& material);
  int ReadTexture(const aiMaterial& in, const Use& use, const std::string& name, std::vector<UvChoice>& uvs);
  UvChoice ReadUvChoice(const aiMaterial& in, aiTextureType type);
  int TextureIndex(const std::string& name, const std::string& folder, const std::string& material, const Use& use);
  std::optional<DecodedImage> Decode(const std::string& name, const std::string& folder, const std::string& material,
                                     bool with_alpha);

  const MeshFile& file_;
  const aiScene& ai_;
  std::vector<MeshMaterial> materials_;  // by the file's index; index -1: not used yet
};

}  // namespace sim
