// Materials, textures and pictures of a glTF file. Private to sim/world.
// Source: Khronos, "glTF 2.0 Specification", 3.8 and 3.9; the extensions of mesh_readers.h.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world/gltf_file.h"

namespace sim {

void WarnOnce(MeshImport& import, const std::string& what);

class GltfMaterials {
 public:
  GltfMaterials(GltfFile& file, MeshImport& import) : file_(file), import_(import) {}

  // The index in materials() of a primitive's material, read when first asked for; without one: glTF's default.
  unsigned MaterialOf(const nlohmann::json& primitive);
  // Whoever takes them owns them.
  const std::vector<aiMaterial*>& materials() const { return materials_; }
  const std::vector<aiTexture*>& textures() const { return textures_; }  // those inside the file

 private:
  // What a texture's image is called: its file, or "*N" of textures(). Empty: none.
  std::string ImageOf(const nlohmann::json& texture);
  std::string Embed(std::string_view bytes);
  void SetTexture(aiMaterial& material, const nlohmann::json& object, const char* key, aiTextureType type);
  void ReadMaterial(const nlohmann::json& in);

  GltfFile& file_;
  MeshImport& import_;
  std::map<std::size_t, std::string> images_;
  std::map<std::optional<std::size_t>, unsigned> material_of_;
  std::vector<aiTexture*> textures_;
  std::vector<aiMaterial*> materials_;
};

}  // namespace sim
