// Vertices of glTF's meshes: the pose of a skin, tangents. Private to sim/world.
// Source: glTF 2.0, sections 3.7.2.1 and 3.7.3.
#pragma once

#include <glm/mat4x4.hpp>
#include <span>

#include "sim/world/gltf_file.h"
#include "sim/world/imported_scene.h"

namespace sim {

// Four joints of each vertex, and their weights.
struct JointWeights {
  GltfTable joints, weights;
};

// Moves vertices to where their joints stand. joints: the file's space from that of the mesh. Throws
// std::runtime_error for a joint that does not exist.
void PoseVertices(std::span<const JointWeights> weights, std::span<const glm::dmat4> joints, ImportedMesh& mesh);

// Whether tangents differ from those of texture coordinates by more than 60 degrees, or in their side, on most
// triangles.
bool ContradictsUvs(const GltfTable& tangents, const ImportedMesh& mesh, const UvChoice& choice);

}  // namespace sim
