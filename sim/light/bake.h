// Purpose: the light of a whole world, computed once for all frames.
#pragma once

#include "sim/light/baked_light.h"
#include "sim/light/params.h"
#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

// Each triangle has one sample at least at its corners, on both sides. Samples of the same place and normal are one, so that
// neighbours meet without a seam where their resolutions (powers of two) agree. Where lamps are baked, a triangle's samples are
// spacing / 4 apart, and are made twice as dense, again and again, about places where four neighbours differ by more than 2 %,
// until they are `finest` apart; between samples that agree, light is interpolated. Works in parallel (in the caller's task
// arena); the result does not depend on the number of threads. `mode` is not direct. Throws std::invalid_argument for bad
// parameters and when more than 2^28 samples would be needed.
BakedLight BakeLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params);

}  // namespace sim
