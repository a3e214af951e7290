// Our readers of meshes, glTF, OBJ and PLY, without the process around them: thousands of runs a second.
#include <csignal>
#include <map>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "sim/world/gltf_file.h"
#include "sim/world/mesh_readers.h"
#include "tests/fuzz/hold.h"

namespace {

struct Format {
  const char* file;  // that changes
  const char* read;  // by the reader
  void (*reader)(sim::MeshFiles&, sim::MeshImport&);
};

Format FormatOf(std::string_view text) {
  if (text.starts_with("glTF")) return {"mesh.glb", "mesh.glb", sim::ReadGltf};
  if (text.starts_with("ply")) return {"mesh.ply", "mesh.ply", sim::ReadPly};
  if (text.starts_with("newmtl")) return {"mesh.mtl", "with_materials.obj", sim::ReadObj};
  if (text.substr(0, text.find_first_not_of(" \n") + 1).ends_with('{'))
    return {"mesh.gltf", "mesh.gltf", sim::ReadGltf};
  return {"mesh.obj", "mesh.obj", sim::ReadObj};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::map<std::string_view, std::unique_ptr<fuzz::InputFile>> files;
  static const bool once = [] {
    std::signal(SIGXCPU, SIG_IGN);  // the limit of an importer's process
    fuzz::WriteBeside("mesh.bin", std::string(256, '\0'));
    fuzz::WriteBeside("with_materials.obj", "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    return true;
  }();
  static_cast<void>(once);
  const Format format = FormatOf({reinterpret_cast<const char*>(data), size});
  auto& file = files[format.file];
  if (!file) file = std::make_unique<fuzz::InputFile>(format.file);
  file->Write({data, size});
  sim::MeshImport import;
  const std::vector<std::filesystem::path> no_folders;
  sim::MeshFiles allowed(fuzz::Folder() / format.read, no_folders, import);
  try {
    format.reader(allowed, import);
    if (import.problem.empty() && sim::CountsOf(import.scene).Problem().empty()) {
      std::vector<std::uint8_t> all;
      sim::WriteBytes(import, [&](fuzz::Bytes bytes) { all.insert(all.end(), bytes.begin(), bytes.end()); });
      sim::ImportFromBytes(all);
    }
  } catch (const sim::OlderGltf&) {  // assimp's
  } catch (const std::bad_alloc&) {
  } catch (const std::exception& error) {
    fuzz::Finding(std::string("an exception leaves the reader: ") + error.what());
  }
  return 0;
}
