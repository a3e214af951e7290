// Reader of PLY, ASCII and binary of both byte orders. Private to sim/world.
// Source: G. Turk, "The PLY Polygon File Format", 1994; texture coordinates of corners and `comment TextureFile` as
// MeshLab (VCGlib) writes them, names of properties as MeshLab, Blender, Open3D and CloudCompare do.
#pragma once

#include "sim/world/mesh_import.h"

namespace sim {

// Polygons and triangle strips; texture coordinates and colours of vertices, of corners (texcoord) and of faces. What is
// wrong with the file is import.problem.
void ReadPly(MeshFiles& files, MeshImport& import);

}  // namespace sim
