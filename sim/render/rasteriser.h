// Rasteriser on OpenGL 4.5: the reflection model of the ray tracer on triangles drawn by a GPU or by Mesa.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/render/renderer.h"
#include "sim/world/scene.h"

namespace sim {

enum class GlPlatform {
  automatic,  // the first of those below that works
  egl,        // libEGL.so.1, on a device that it lists (GPUs first) or surfaceless; no display
  osmesa      // libOSMesa.so: Mesa in software. No longer a part of Mesa since 25.1
};

struct RasteriserOptions {
  GlPlatform platform = GlPlatform::automatic;
  // Pictures averaged for each time sample, each with its own point of the pixels.
  int rays_per_time_sample = 1;
  bool jitter = true;  // false: every ray goes through the pixel's centre (for comparisons with closed forms)
  bool shadows = true;
  int shadow_map_side = 1024;  // [texel] 16 ... 8192: a shadow's edge is off by a few times what one covers
  int strip_rows = 8;          // of a rolling shutter: rows that share the moment of their middle
};

// Copies what it needs of the scene. As the ray tracer (sim/render/ray_tracer.h) with these differences:
// - All pixels of a sample share its moment and its point of the pixel and of the lens; the points' mean is the middle.
//   `key` has no effect. Long blur at few time samples consists of discrete copies instead of noise.
// - An edge is off by up to 1/256 pixel, and by up to 1/4 pixel through a lens that is no pinhole; what lies between
//   edges is where the ray tracer has it.
// - Shadows are looked up in maps: their edges are soft and off by about two texels of a map, 4 / shadow_map_side of
//   the distance from a lamp, 2 / shadow_map_side of the scene's size for a sun. What is nearer than 1 cm to a lamp
//   casts none.
// - Surfaces nearer than 1 cm (Z; with a lens wider than 50 degrees: along the largest component) are clipped.
// Expose throws std::invalid_argument for a lens that would need too large a picture.
// The bytes are the same on one machine with one OpenGL; another one's differ, in edges and by rounding. Calls are
// serialised. Elements of the scene that are not rendered are named in sentences appended to `warnings`.
// Throws std::invalid_argument for options out of range and a scene whose indices are, or that is too large;
// std::runtime_error with the reason when there is no OpenGL 4.5 without a display.
std::unique_ptr<Renderer> MakeRasteriser(const Scene& scene, const RasteriserOptions& options = {},
                                         std::vector<std::string>* warnings = nullptr);

}  // namespace sim
