// Purpose: the renderer on Embree: primary rays, Lambert shading, shadow rays, filtered textures.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/light/bake.h"
#include "sim/render/renderer.h"
#include "sim/world/scene.h"

namespace sim {

struct RayTracerOptions {
  // Rays per pixel and time sample. More than one pays only where there are few time samples: each has its own point in
  // the pixel.
  int rays_per_time_sample = 1;
  bool jitter = true;        // false: every ray goes through the pixel's centre (for comparisons with closed forms)
  int jobs = 0;              // threads; 0: as many as the machine has. Never changes the result
  bool reflections = false;  // of metal and gloss, one ray more each; without, all is Lambert
  LightMode light = LightMode::direct;
  BakeParams bake;
  std::vector<std::filesystem::path> light_folders;  // where baked light is kept (sim/light/cache.h)
};

// Copies what it needs of the scene. The radiance of a surface with albedo a is
//   L = emission + a * (sum of ambient radiances + 1/pi * sum over the other lights of V * E),
// with E the irradiance of sim/world/light.h and V = 0 where a shadow ray meets a surface; with baked light, that takes the place
// of ambient light, and of the other lights too where they are baked; objects that move keep both, and cast shadows on what is
// not baked. Textures are filtered over
// each ray's share of the pixel, 1/sqrt(number of rays) of its side. With reflections, what mirrors is sim/render/packet_gloss.inc's model instead. The bytes are the same on machines with the same
// vector instructions; between others (base, AVX2, AVX-512) they differ by rounding. Throws std::invalid_argument for
// options out of range and for a scene whose indices are; std::runtime_error when Embree fails. What was readable but is probably
// not meant is appended to `warnings`, where there are any.
std::unique_ptr<Renderer> MakeRayTracer(const Scene& scene, const RayTracerOptions& options = {},
                                        std::vector<std::string>* warnings = nullptr);

}  // namespace sim
