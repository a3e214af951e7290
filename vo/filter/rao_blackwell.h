// Rao-Blackwell steps of one particle: prediction of the sampled state, and the velocity given it.
// Source:  (12)(13), (37)-(43); orientation by the rotation since the last sampled pose (docs/algorithm.md, section 4).
// State:   s_pf = (p, delta) [m in W, rad in C], s_kf = (v, w).
#pragma once

#include "vo/filter/motion_model.h"
#include "vo/filter/particle.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {

// F and Q over dt > 0 [s], split into s_pf and s_kf.
CameraVelocityFilter VelocityFilterOver(const MotionParams& motion, double dt);

// s_pf of a pose that was sampled: delta = 0.
Vector6 PathState(const Pose& sampled);

// (12)(13): the next pose before it is sampled. `covariance` is (13), the same for all particles.
PoseGaussian PredictPose(const CameraVelocityFilter& step, const Particle& particle, const Matrix6& covariance);
// delta of (12), the rotation that is predicted.
Eigen::Vector3d PredictedTurn(const CameraVelocityFilter& step, const Particle& particle);

// (37)-(43) with the sampled pose as the measurement. `turn`: the predicted rotation, which selects among those that
// differ by full turns.
CameraVelocityFilter::State VelocityGivenPose(const CameraVelocityFilter::Gain& gain, const Pose& previous,
                                              const Pose& sampled, const Eigen::Vector3d& turn);

}  // namespace vo
