// Textures that do not repeat: outside their edges the last texel continues (clamp), or every second copy is mirrored.
// As renderers only repeat, triangles are cut at the discontinuities, and the pieces have coordinates within the
// picture. Private to sim/world.
// Source: glTF 2.0, 3.8.4.5 (wrapping); OpenGL 4.6, 8.14.2.
#pragma once

#include "sim/world/scene.h"

namespace sim {

enum class UvWrap { repeat, clamp, mirror };

// axis: 0 (u) or 1 (v); texels: of the picture along it. Returns false, without effect, where a mirrored picture would
// repeat more than 100 times.
bool WrapUvs(Mesh& mesh, int axis, UvWrap wrap, int texels);

}  // namespace sim
