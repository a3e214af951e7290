// Readers of mesh files. Problems of a file go to import.problem. Private to sim/world.
#pragma once

#include <cstring>

#include "sim/world/mesh_import.h"

namespace sim {

// Wavefront OBJ with its material libraries. Polygons of any number of corners; lines, points, curves are left out.
// Problems have lines.
// Source: "Object Files (.obj)" and "MTL Material Format", Alias|Wavefront Advanced Visualizer, appendix B; vertex
// colours (x y z r g b) as MeshLab and Blender write them, in comments (#MRGB) as ZBrush does; Pm, Pr, norm of
// Exocortex' extension.
void ReadObj(MeshFiles& files, MeshImport& import);

// PLY, ASCII and binary of both byte orders. Polygons and triangle strips; texture coordinates and colours of vertices,
// of corners (texcoord) and of faces.
// Source: G. Turk, "The PLY Polygon File Format", 1994; texture coordinates of corners and `comment TextureFile` as
// MeshLab (VCGlib) writes them, names of properties as MeshLab, Blender, Open3D and CloudCompare do.
void ReadPly(MeshFiles& files, MeshImport& import);

// OFF in text, with normals, texture coordinates and colours of vertices (NOFF, STOFF, COFF) and colours of faces.
// Source: Geomview manual, "OFF: Object File Format".
void ReadOff(MeshFiles& files, MeshImport& import);

// STL in text (several solids) and binary, with colours of VisCAM and Magics. What is in front is said by the order of
// the corners; normals are not read.
// Source: 3D Systems, "StereoLithography Interface Specification", 1989; Materialise Magics and VisCAM for colours.
void ReadStl(MeshFiles& files, MeshImport& import);

// 3MF in its unit: objects, components, build items, also of several model parts; base materials, colours and pictures
// of triangles and their corners.
// Source: 3MF Consortium, Core 1.3, Materials and Properties 1.2.1, Production 1.1.2; PKWARE, APPNOTE 6.3.9 (zip).
void Read3mf(MeshFiles& files, MeshImport& import);

// glTF 2.0 (.gltf, .glb): the default scene, without animations. Throws OlderGltf for glTF 1.0. An unsupported
// extension is import.problem where the file requires it, and a warning where the file uses it.
// Source: Khronos, "glTF 2.0 Specification"; KHR_texture_transform, KHR_materials_unlit,
// KHR_materials_emissive_strength, KHR_materials_pbrSpecularGlossiness, KHR_mesh_quantization,
// KHR_draco_mesh_compression, EXT_meshopt_compression, EXT_texture_webp, EXT_mesh_gpu_instancing.
void ReadGltf(MeshFiles& files, MeshImport& import);
// Its cameras alone: no mesh is read.
void ReadGltfCameras(MeshFiles& files, MeshImport& import);

// All other formats. FBX is in its unit and its axes, which assimp (5.2) does not convert.
void ReadByAssimp(MeshFiles& files, MeshImport& import);

// The number of type T at an address.
template <class T>
double NumberAt(const void* from) {
  T value{};
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

}  // namespace sim
