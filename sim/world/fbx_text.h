// Parts of FBX files that assimp (5.2) leaves out without a message. Private to sim/world.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sim {

// Warnings of textures that are clamped (WrapMode) or layered, of hidden objects (Show, Visibility) and of levels of
// detail: all change the picture. file: binary or text.
std::vector<std::string> FbxWarnings(std::string_view file);

}  // namespace sim
