// Serialisation of an import, for the way out of its process. Private to sim/world.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/world/mesh_import.h"

namespace sim {

// The limit on the counts of a whole file that is exceeded; empty: none.
std::string MeshCountProblem(const aiScene& scene);

// Of the scene only what the loader reads: nodes, meshes (positions, normals, first colours, texture coordinates,
// faces), materials, textures.
std::vector<std::uint8_t> ToBytes(const MeshImport& import);
// Throws std::runtime_error where the bytes end too early or name what is not there.
MeshImport ImportFromBytes(std::span<const std::uint8_t> bytes);

}  // namespace sim
