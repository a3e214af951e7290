// Baking of irradiance for all frames: indirect light of static surfaces and, optionally, light of lamps.
// Private to sim.
#pragma once

#include <string>
#include <vector>

#include "sim/light/params.h"
#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

// Samples on a regular lattice on both sides of each triangle, at most `spacing` apart (a side is divided into at most
// 2^8). Samples of equal position and normal are shared, so that neighbours join without a seam where their resolutions
// (powers of two) agree. Where lamps are baked, lattices are refined by factors of two: everywhere to spacing / 4, then
// wherever four neighbours differ by more than 2 %, down to `min_spacing` (a side is divided into at most 2^11). Light
// is interpolated linearly in between. Parallel in the caller's task arena; the result does not depend on the number of
// threads. `mode` is not direct. Throws std::invalid_argument for bad parameters and for more than 2^28 samples.
BakedLight BakeLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params);

// Limits of the light that BakeLight computes for this scene, a sentence each: samples that are farther apart than
// `spacing` or, where lamps are baked, than `min_spacing`; ambient light and moving objects, which are not in it.
std::vector<std::string> BakeWarnings(const Scene& scene, const RayScene& rays, LightMode mode,
                                      const BakeParams& params);

}  // namespace sim
