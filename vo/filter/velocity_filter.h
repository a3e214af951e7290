// Rao-Blackwell steps of one particle: prediction of the sampled state, and the Kalman filter of the velocity, which is
// Gaussian conditional on the sampled path. Each sampled step is a measurement whose noise is correlated with the
// process noise.
// Source:  (10), (12)(13), (18)-(25) and Algorithm 1, (37)-(43); orientation by the rotation since the last sampled
//          pose (docs/algorithm.md, section 4). Three places differ from print: Psi is a square root (18); the cross
//          terms of P_mm are H Gamma Lambda' and its transpose (41); the sign in (43) is minus.
// State:   s_pf = (p, delta) [m in W, rad in C], s_kf = (v, w). Works for any F with F22 invertible and any Q with
//          Q22 > 0.
#pragma once

#include "vo/filter/motion_model.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {

// Particle-independent terms of one time step.
class VelocityFilter {
 public:
  struct State {
    Vector6 mean = Vector6::Zero();
    Matrix6 covariance = Matrix6::Zero();
  };

  explicit VelocityFilter(const MotionModel& step);
  // Over dt > 0 [s].
  VelocityFilter(const MotionParams& motion, double dt, const MotionInput& input = {})
      : VelocityFilter(NearlyConstantVelocity(motion, dt, input)) {}

  // (12)(13): the next s_pf before it is sampled.
  Vector6 PredictedMean(const Vector6& s_pf, const State& s_kf) const;
  Matrix6 PredictedCovariance(const State& s_kf) const;

  struct Gain {
    Vector6 mean;        // s_kf = mean + matrix * s_pf, before s_pf is known
    Matrix6 matrix;      // P_vm P_mm^-1
    Matrix6 covariance;  // of s_kf, given s_pf
    State Given(const Vector6& s_pf) const { return {mean + matrix * s_pf, covariance}; }
  };

  // (37)-(43) as a function of the s_pf still to be sampled.
  Gain Condition(const Vector6& s_pf_previous, const State& s_kf) const;
  // The same in two parts. The first is common to all particles of equal covariance, and leaves the mean to the second.
  Gain ConditionCovariance(const Matrix6& covariance) const;
  void ConditionMean(const Vector6& s_pf_previous, const Vector6& mean, Gain& gain) const;

 private:
  Matrix6 F11_, F12_, F21_, Phi_, Q11_, Q12_, Gamma_, H_, Lambda_, Psi_Psi_, m_previous_;
  bool has_decayed_;  // then the same without F22's inverse
};

// s_pf of a pose that was sampled: delta = 0.
Vector6 PathState(const Pose& sampled);

// (12)(13): the pose after `pose` before it is sampled. `covariance` is (13), the same for all particles.
PoseGaussian PredictPose(const VelocityFilter& step, const Pose& pose, const VelocityFilter::State& velocity,
                         const Matrix6& covariance);
// delta of (12), the rotation that is predicted.
Eigen::Vector3d PredictedTurn(const VelocityFilter& step, const Pose& pose, const VelocityFilter::State& velocity);

// (37)-(43) with the sampled pose as the measurement. `turn`: the predicted rotation, which selects among those that
// differ by full turns.
VelocityFilter::State VelocityGivenPose(const VelocityFilter::Gain& gain, const Pose& previous, const Pose& sampled,
                                        const Eigen::Vector3d& turn);

}  // namespace vo
