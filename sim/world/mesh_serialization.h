// Serialisation of an imported scene, for the way out of the import process (mesh_import.h). Private to sim/world.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sim {

// The limit on the counts of a whole file that is exceeded; empty: none.
std::string MeshCountProblem(const aiScene& scene);

// Only what the loader reads: nodes, meshes (positions, normals, first colours, texture coordinates, faces), materials,
// textures.
std::vector<std::uint8_t> ToBytes(const aiScene& scene);
// Throws std::runtime_error where the bytes end too early or name what is not there.
std::unique_ptr<aiScene> SceneFromBytes(std::span<const std::uint8_t> bytes);

}  // namespace sim
