// Settings of Algorithm 1: each particle's pose is sampled at once and weighed by its evidence.
#pragma once

#include "vo/base/params.h"

namespace vo_test {

inline vo::FilterParams SampledAtOnce() {
  vo::FilterParams params;
  params.particles = 8;
  params.weight = vo::Weight::evidence;
  params.lag = 0;
  return params;
}

// The same on images, with constant process noise and a given camera.
inline vo::Params ConstantNoise() {
  vo::Params params;
  params.filter = SampledAtOnce();
  params.motion.adaptive = false;
  params.landmark.scale_sigma = 0;
  params.landmark.proving_matches = 0;
  params.calibration.estimate = false;
  return params;
}

}  // namespace vo_test
