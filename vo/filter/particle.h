// Particle: one hypothesis of the sampled path, and what is Gaussian given that path.
// Frames:  poses T_WC.
#pragma once

#include <vector>

#include "vo/filter/mixture.h"
#include "vo/map/landmark.h"

namespace vo {

struct Particle {
  Pose pose;                             // the last one sampled
  CameraVelocityFilter::State velocity;  // given the path: (v in W, w in C); all particles have the same covariance
  std::vector<Landmark> landmarks;       // given the path
  std::vector<Pose> anchors;             // of the landmarks' first views, on this particle's path
  double log_weight = 0;
};

}  // namespace vo
