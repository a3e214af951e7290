// Triangles that coincide with others turned the other way: surfaces whose sides differ, as modelling programs write
// them.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/world/scene.h"

namespace sim {

// Moves the triangles of meshes[first ...] that have such a twin among them, with the same corners to the last bit,
// into meshes of the same name that are one-sided. Expected time: O(n) for n triangles, and sorting those with a twin.
void SeparateCoincidentFaces(std::vector<Mesh>& meshes, std::size_t first);

}  // namespace sim
