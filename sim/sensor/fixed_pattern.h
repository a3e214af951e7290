// Fixed-pattern noise: spatial nonuniformity of sensitivity (PRNU) and dark current (DSNU), EMVA 1288.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensor/description.h"

namespace sim {

// Of every pixel and channel, in the image's order; empty: the same for all. A function of the settings, the size and
// the seed.
struct FixedPattern {
  std::vector<float> sensitivity;  // factor of the light, >= 0
  std::vector<float> dark_e_s;     // dark current [electrons / s], >= 0
};

bool HasFixedPattern(const SensorParams& params);
FixedPattern MakeFixedPattern(const SensorParams& params, std::uint64_t seed, int width, int height, int channels);

}  // namespace sim
