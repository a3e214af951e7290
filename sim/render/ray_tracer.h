// Ray tracer on Embree: primary rays, Lambertian reflection, shadow rays, filtered textures.
#pragma once

#include <memory>

#include "sim/render/renderer.h"
#include "sim/world/scene.h"

namespace sim {

class RayScene;

struct RayTracerOptions {
  // Rays per pixel and time sample. More than one pays only with few time samples: each has its own point in the pixel.
  int rays_per_time_sample = 1;
  bool jitter = true;        // false: every ray goes through the pixel's centre (for comparisons with closed forms)
  int jobs = 0;              // threads; 0: as many as the machine has. Never changes the result
  bool reflections = false;  // of metal and gloss, one ray more each; without, all is Lambert
};

// Radiance of a surface with albedo a:
//   L = emission + a * (sum of ambient radiances + 1/pi * sum over the other lights of V * E),
// with E the irradiance of sim/world/light.h and V = 0 where a shadow ray meets a surface. With baked light in `rays`,
// that takes the place of ambient light, and of the other lights too where they are baked; objects that move keep both,
// and cast shadows on what is not baked. Textures are filtered over each ray's share of the pixel, 1/sqrt(number of
// rays) of its side. With reflections, what mirrors is sim/render/packet_gloss.inc's model instead. The bytes are the
// same on machines with the same vector instructions; between others (base, AVX2, AVX-512) they differ by rounding.
// Copies what it needs of the scene. Throws std::invalid_argument for options out of range and for a scene whose
// indices are; std::runtime_error when Embree fails.
std::unique_ptr<Renderer> MakeRayTracer(const Scene& scene, const RayTracerOptions& options = {});
// `rays` are of this scene (sim/light/cache.h: with baked light).
std::unique_ptr<Renderer> MakeRayTracer(const Scene& scene, std::unique_ptr<RayScene> rays,
                                        const RayTracerOptions& options);

}  // namespace sim
