// Mesh files of all formats.
#include "sim/world/scene.h"
#include "tests/fuzz/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sim::WorldDescription world;
  world.meshes.emplace_back().file = fuzz::WriteMesh({data, size});
  fuzz::Hold(fuzz::Folder().string(), [&] { sim::LoadScene(world); });
  return 0;
}
