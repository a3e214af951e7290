// Reader of Wavefront OBJ files and their material libraries. Private to sim/world.
// Source: "Object Files (.obj)" and "MTL Material Format", Alias|Wavefront Advanced Visualizer, appendix B; vertex
// colours (x y z r g b) as MeshLab and Blender write them; Pm, Pr, norm of Exocortex' extension.
#pragma once

#include "sim/world/mesh_import.h"

namespace sim {

// Polygons of any number of corners; lines, points and curves are left out. What is wrong with the file is
// import.problem, with lines.
void ReadObj(MeshFiles& files, MeshImport& import);

}  // namespace sim
