// Purpose: moments of the mixture over particles that is the filter's answer (algorithm, sections 9 and 6 of the metrics):
//          covariance = sum_i w_i (P_i + (mu_i - mu)(mu_i - mu)').
#pragma once

#include <vector>

#include "vo/filter/particle_filter.h"

namespace vo {

// One particle's Gaussian over (pose, velocity) just before the pose is sampled; covariance in the tangent space at `pose`.
struct BeliefComponent {
  Pose pose;
  Vector6 velocity;
  Matrix12 covariance;
};

// The velocity is an affine function of the pose still to be sampled, plus its own covariance.
BeliefComponent Component(const PoseGaussian& pose, const Pose& previous, const CameraVelocityFilter::Gain& gain);

Belief Moments(const std::vector<BeliefComponent>& mixture, const std::vector<double>& weights);

}  // namespace vo
