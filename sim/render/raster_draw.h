// Depth-tested drawing of triangles with reversed Z: 1 at the near plane, 0 at infinity. Private to sim/render.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "sim/render/gl_objects.h"
#include "sim/render/raster_scene.h"

namespace sim {

// What is nearer, along the view's axis, is not seen [m]. Depth is kNear / z in 32-bit floats, so that its error is
// 1e-7 z relative far from the near plane; for a triangle that reaches up to the near plane it is 1e-7 z / kNear.
constexpr float kNear = 0.01f;

// From a view's axes (x right, y down, z along) to clip space: `low` and `high` are the tangents of its corners.
glm::mat4 ClipFromView(const glm::vec2& low, const glm::vec2& high);

// Draws the depth alone of all triangles into a layer of a texture array. clip: of positions less `origin`.
void DrawDepth(const GlApi& gl, const RasterScene& scene, const Program& triangles, const glm::vec3& origin,
               const glm::mat4& clip, const GlObject& maps, int layer, int side);

}  // namespace sim
