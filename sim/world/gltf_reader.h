// Reader of glTF 2.0 (.gltf, .glb): the default scene as it stands, without animations. Private to sim/world.
// Source: Khronos, "glTF 2.0 Specification"; KHR_texture_transform, KHR_materials_unlit, KHR_materials_emissive_strength,
// KHR_materials_pbrSpecularGlossiness, KHR_mesh_quantization, KHR_draco_mesh_compression, EXT_meshopt_compression,
// EXT_texture_webp, EXT_mesh_gpu_instancing.
#pragma once

#include "sim/world/mesh_import.h"

namespace sim {

// Throws OlderGltf for glTF 1.0. An extension that the file requires and that is not known here is import.problem; one
// that it uses is a warning.
void ReadGltf(MeshFiles& files, MeshImport& import);

}  // namespace sim
