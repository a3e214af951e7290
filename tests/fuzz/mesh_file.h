// The mesh file of a run: its format distinguished by its first bytes. Materials of an OBJ and data of a glTF are
// beside it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "tests/fuzz/hold.h"

namespace fuzz {

inline std::string MeshExtension(std::string_view text) {
  if (text.starts_with("glTF")) return "glb";
  if (text.starts_with("ply")) return "ply";
  if (text.starts_with("PK")) return "3mf";
  if (text.substr(0, 6).find("OFF") != std::string_view::npos) return "off";
  if (text.starts_with("solid") || (text.size() > 84 && text[0] == '\0')) return "stl";
  if (text.starts_with("Kaydara") || text.starts_with("; FBX")) return "fbx";
  if (text.starts_with("<")) return "dae";
  if (text.starts_with("newmtl")) return "mtl";
  if (text.substr(0, text.find_first_not_of(" \n") + 1).ends_with('{')) return "gltf";
  return "obj";
}

// Writes it. Returns the mesh to read: itself, or one that names it as its material library.
inline std::filesystem::path WriteMesh(Bytes bytes) {
  static std::map<std::string, std::unique_ptr<InputFile>> files;
  if (files.empty()) {
    WriteBeside("mesh.bin", std::string(256, '\0'));
    WriteBeside("with_materials.obj", "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  }
  const std::string extension = MeshExtension({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  auto& file = files[extension];
  if (!file) file = std::make_unique<InputFile>("mesh." + extension);
  file->Write(bytes);
  return Folder() / (extension == "mtl" ? "with_materials.obj" : "mesh." + extension);
}

}  // namespace fuzz
