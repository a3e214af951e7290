// URDF as libsdformat 12 takes it. Private to tools/bench/import.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "sim/world/mesh_loader.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace vobench {

inline constexpr char kUnknownShape[] = "a shape that is none of box, sphere, cylinder, plane and mesh is left out";

// All elements below one, in order of the file.
void ForEachElement(tinyxml2::XMLElement& of, const std::function<void(tinyxml2::XMLElement&)>& call);

// Text of a URDF that libsdformat reads whole: it leaves out links without inertia or mass, and all visuals of a link
// that has one of an unknown shape, and makes textures black. visuals: number of those with known shapes. Throws
// std::runtime_error for xacro, "FILE:LINE: why".
std::string ReadableUrdf(const std::filesystem::path& file, tinyxml2::XMLDocument& xml, std::size_t& visuals,
                         sim::WarningList& warnings);

}  // namespace vobench
