// Textures that do not repeat: outside their edges the last texel goes on (clamp), or every second copy is mirrored.
// Renderers repeat, so that triangles are cut where the coordinates' course breaks, and the pieces have coordinates
// within the picture. Private to sim/world.
// Source: glTF 2.0, 3.8.4.5 (wrapping); OpenGL 4.6, 8.14.2.
#pragma once

#include "sim/world/scene.h"

namespace sim {

enum class UvWrap { repeat, clamp, mirror };

// axis: 0 (u) or 1 (v); texels: of the picture along it. False, and nothing is done, where a mirrored picture would
// come more than 100 times.
bool WrapUvs(Mesh& mesh, int axis, UvWrap wrap, int texels);

}  // namespace sim
