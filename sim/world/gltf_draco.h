// Meshes compressed by Draco (KHR_draco_mesh_compression). Private to sim/world.
// Source: github.com/KhronosGroup/glTF, extensions/2.0/Khronos/KHR_draco_mesh_compression; google.github.io/draco/spec.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/world/gltf_file.h"

namespace sim {

struct DracoMesh {
  std::vector<std::uint32_t> indices;           // of triangles
  std::map<std::string, GltfTable> attributes;  // by glTF's name
};

struct DracoAttribute {
  std::uint32_t id;
  int component_type;  // of the accessor that it stands for
  bool normalised;
};

// Throws std::runtime_error for damaged data, and for an attribute that is not in it.
DracoMesh DecodeDraco(std::span<const std::uint8_t> bytes, const std::map<std::string, DracoAttribute>& attributes);

}  // namespace sim
