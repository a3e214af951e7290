// Purpose: the light of a whole world, computed once for all frames.
#pragma once

#include <string>
#include <vector>

#include "sim/light/baked_light.h"
#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

enum class LightMode {
  direct,          // lamps with shadow rays in each frame, and ambient light; nothing is baked
  baked_indirect,  // lamps with shadow rays in each frame; the sky and all that bounces is baked
  baked            // all is baked: frames cost only their primary rays
};

struct BakeParams {
  double spacing_m = 0.1;  // at most, between samples of a triangle's light
  double finest_m = 0.01;  // at an edge of a lamp's light, where that is baked too
  int paths = 256;         // of each sample: a power of two
  int lamp_rays = 64;      // of each sample to each area lamp, where lamps are baked: a power of two
};
std::vector<std::string> Problems(const BakeParams& params);

// Each triangle has one sample at least at its corners, on both sides. Samples of the same place and normal are one, so that
// neighbours meet without a seam where their resolutions (powers of two) agree. Where lamps are baked, a triangle's samples are
// spacing / 4 apart, and are made twice as dense, again and again, about places where four neighbours differ by more than 2 %,
// until they are `finest` apart; between samples that agree, light is interpolated. Works in parallel (in the caller's task
// arena); the result does not depend on the number of threads. `mode` is not direct. Throws std::invalid_argument for bad
// parameters and when more than 2^28 samples would be needed.
BakedLight BakeLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params);

}  // namespace sim
