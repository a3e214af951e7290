// Purpose: the light of a whole world, computed once for all frames.
#pragma once

#include <string>
#include <vector>

#include "sim/light/params.h"
#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

// Each triangle has one sample at least at its corners, on both sides. Samples of the same place and normal are one, so
// that neighbours meet without a seam where their resolutions (powers of two) agree. They are `spacing` apart at most, as
// long as no side is divided into more than 2^8. Where lamps are baked, a triangle's samples are made twice as dense,
// again and again: everywhere until they are spacing / 4 apart, then about places where four neighbours differ by more
// than 2 %; until they are `finest` apart or a side is divided into 2^11. Between samples that agree, light is
// interpolated. Works in parallel (in the caller's task arena); the result does not depend on the number of threads.
// `mode` is not direct. Throws std::invalid_argument for bad parameters and when more than 2^28 samples would be needed.
BakedLight BakeLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params);

// Limits of the light that BakeLight computes for this scene, a sentence each: samples that are farther apart than `spacing` or, where
// lamps are baked, than `finest`; ambient light and moving objects, which are not in it.
std::vector<std::string> BakeWarnings(const Scene& scene, const RayScene& rays, LightMode mode,
                                      const BakeParams& params);

}  // namespace sim
