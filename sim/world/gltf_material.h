// Materials, textures and pictures of a glTF file. Private to sim/world.
// Source: Khronos, "glTF 2.0 Specification", 3.8 and 3.9; the extensions of mesh_readers.h.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world/gltf_file.h"

namespace sim {

class GltfMaterials {
 public:
  GltfMaterials(GltfFile& file, MeshImport& import) : file_(file), import_(import) {}

  // The index in the scene of a primitive's material, read at its first use; without one: glTF's default.
  unsigned MaterialOf(const nlohmann::json& primitive);

 private:
  // Of a texture: its file, or a picture of the scene.
  ImportedMap ImageOf(const nlohmann::json& texture);
  ImportedMap Embed(std::string_view bytes);
  ImportedMap MapOf(const nlohmann::json& object, const char* key);
  ImportedMaterial Read(const nlohmann::json& in);

  GltfFile& file_;
  MeshImport& import_;
  std::map<std::size_t, ImportedMap> images_;
  std::map<std::optional<std::size_t>, unsigned> material_of_;
};

}  // namespace sim
