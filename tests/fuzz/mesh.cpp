// Mesh files of all formats, distinguished by their first bytes. Materials of an OBJ and data of a glTF are beside it.
#include <map>
#include <memory>
#include <string_view>

#include "sim/world/scene.h"
#include "tests/fuzz/hold.h"

namespace {

const char* ExtensionOf(std::string_view text) {
  if (text.starts_with("glTF")) return "glb";
  if (text.starts_with("ply")) return "ply";
  if (text.starts_with("solid") || (text.size() > 84 && text[0] == '\0')) return "stl";
  if (text.starts_with("Kaydara") || text.starts_with("; FBX")) return "fbx";
  if (text.starts_with("<")) return "dae";
  if (text.starts_with("newmtl")) return "mtl";
  if (text.substr(0, text.find_first_not_of(" \n") + 1).ends_with('{')) return "gltf";
  return "obj";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::map<std::string, std::unique_ptr<fuzz::InputFile>> files;
  static const bool once = [] {
    fuzz::WriteBeside("mesh.bin", std::string(256, '\0'));
    fuzz::WriteBeside("with_materials.obj", "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    return true;
  }();
  static_cast<void>(once);
  const std::string extension = ExtensionOf({reinterpret_cast<const char*>(data), size});
  auto& file = files[extension];
  if (!file) file = std::make_unique<fuzz::InputFile>("mesh." + extension);
  file->Write({data, size});
  sim::WorldDescription world;
  world.meshes.emplace_back().file = fuzz::Folder() / (extension == "mtl" ? "with_materials.obj" : "mesh." + extension);
  fuzz::Hold(fuzz::Folder().string(), [&] { sim::LoadScene(world); });
  return 0;
}
