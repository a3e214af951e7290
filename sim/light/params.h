// Parameters of the illumination: which part of it is baked, and how finely.
#pragma once

#include <string>
#include <vector>

namespace sim {

enum class LightMode {
  direct,          // lamps with shadow rays in each frame, and ambient light; nothing is baked
  baked_indirect,  // lamps with shadow rays in each frame; the sky and all that bounces is baked
  baked            // all is baked: frames cost only their primary rays
};

struct BakeParams {
  double spacing_m = 0.1;  // at most, between samples of a triangle's light; a side is divided into 2^8 at most
  double finest_m = 0.01;  // at an edge of a lamp's light, where that is baked too; into 2^11 at most
  int paths = 256;         // of each sample: a power of two
  int lamp_rays = 64;      // of each sample to each area lamp, where lamps are baked: a power of two
};
std::vector<std::string> Problems(const BakeParams& params);

}  // namespace sim
