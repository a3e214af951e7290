// Our readers of meshes, glTF, OBJ, PLY, OFF, STL and 3MF, without the process around them: thousands of runs a second.
#include <csignal>
#include <new>
#include <vector>

#include "sim/world/gltf_file.h"
#include "sim/world/mesh_readers.h"
#include "tests/fuzz/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::signal(SIGXCPU, SIG_IGN);  // the limit of an importer's process
  const std::filesystem::path mesh = fuzz::WriteMesh({data, size});
  const std::string extension = mesh.extension();
  const auto reader = extension == ".gltf" || extension == ".glb" ? sim::ReadGltf
                      : extension == ".ply"                       ? sim::ReadPly
                      : extension == ".off"                       ? sim::ReadOff
                      : extension == ".stl"                       ? sim::ReadStl
                      : extension == ".3mf"                       ? sim::Read3mf
                                                                  : sim::ReadObj;
  sim::MeshImport import;
  const std::vector<std::filesystem::path> no_folders;
  sim::MeshFiles allowed(mesh, no_folders, import);
  try {
    reader(allowed, import);
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
