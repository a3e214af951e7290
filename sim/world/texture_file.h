// File of a texture or material library from its name in a mesh file: paths of any system, in any folder that may be
// read. Private to sim/world.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

// ASCII letters in lower case, and ".obj" of "ROOM.OBJ".
std::string Lower(std::string text);
std::string LowerExtension(const std::filesystem::path& file);
// "%20" and the like, of URIs.
std::string DecodePercent(const std::string& text);

struct TextureFile {
  std::filesystem::path file;
  bool is_elsewhere = false;  // found by its last part, or with other capitals
  std::string problem{};      // why there is none; empty: there is
};

// name: relative to `folder` (itself relative to the mesh's) or to the mesh's folder; with '/' or '\', percent-encoded
// or not. A missing file is searched by the last part of its name beside the mesh and in `folders`.
TextureFile FindTexture(const std::string& name, const std::filesystem::path& mesh, const std::string& folder,
                        const std::vector<std::filesystem::path>& folders);

}  // namespace sim
