// Purpose: what an importer made of a mesh file, as bytes: it comes from another process (mesh_import.h). Private to
// sim/world.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sim {

// Of limits on what a file may unpack to; empty: none is exceeded. Counts are of the whole file.
std::string MeshCountProblem(const aiScene& scene);

// Nodes, meshes (positions, normals, first colours, texture coordinates, faces), materials and textures: what is made
// use of.
std::vector<std::uint8_t> ToBytes(const aiScene& scene);
// Throws std::runtime_error where the bytes end too early or name what is not there.
std::unique_ptr<aiScene> SceneFromBytes(std::span<const std::uint8_t> bytes);

}  // namespace sim
