// Moments of the mixture over particles, the filter's answer: covariance = sum_i w_i (P_i + (mu_i - mu)(mu_i - mu)').
// Source:  docs/algorithm.md, section 1.
#pragma once

#include <vector>

#include "vo/filter/velocity_filter.h"

namespace vo {

// One particle's Gaussian over (pose, velocity) just before the pose is sampled; covariance in the tangent space at
// `pose`.
struct BeliefComponent {
  double weight = 0;
  Pose pose;
  Vector6 velocity;     // (v in W, w in C)
  Matrix12 covariance;  // (dp in W, dphi in C, dv in W, dw in C)
};

struct Belief {
  Pose pose;
  Vector6 velocity = Vector6::Zero();
  Matrix12 covariance = Matrix12::Zero();
};

// The velocity is an affine function of the pose still to be sampled, plus its own covariance. `turn`: since
// `previous`, as predicted [rad in C].
BeliefComponent Component(const PoseGaussian& pose, const Pose& previous, const Eigen::Vector3d& turn,
                          const VelocityFilter::Gain& gain);

// Weights sum to 1.
Belief Moments(const std::vector<BeliefComponent>& mixture);

}  // namespace vo
