// Cache of decoded textures on disk, beside that of baked light. Private to sim/world.
//
// A file's name is the hash of the pictures' bytes and of their processing: a changed picture has another name,
// whatever its time stamp. Content: the word "vobench texture", that hash, sizes, texels, alpha, and their checksum.
// Written under a temporary name and renamed.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/world/imported_scene.h"
#include "sim/world/texture.h"

namespace sim {

// Read from the first folder that has it; else made, and where it is large written to the first writable folder. Only
// pictures that are files are kept. `use`: other inputs of `make`. A damaged or unwritable file is ignored.
Texture CachedTexture(const std::string& name, std::span<const ImportedPicture> from, std::uint64_t use,
                      const std::vector<std::filesystem::path>& folders, const std::function<Texture()>& make);

}  // namespace sim
