// Prior of several steps by the motion model: the Gaussian of u_k = (p_k - p_k-1, LogNear(q_k-1^-1 q_k, its
// prediction)), k = 1 ... m, with the velocities integrated out, and of the last velocity given the steps.
// Source:  (6)-(9) in these coordinates are linear: u_k = F12 v_k-1 + noise, v_k = F22 v_k-1 + noise, the two noises
//          correlated. The covariances do not depend on the path: all particles share them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vo/filter/motion_model.h"

namespace vo {

constexpr Eigen::Index kPoseSize = 6;  // rows of a pose, or a step, in a vector of several

class PathPrior {
 public:
  // Steps in order of time; covariance of the velocity at the start of the first.
  PathPrior(const std::vector<MotionModel>& steps, const Matrix6& velocity_covariance);

  int size() const { return static_cast<int>(mean_of_step_.size()); }
  const Eigen::MatrixXd& precision() const { return precision_; }  // of u, 6m x 6m
  double log_det_precision() const { return log_det_precision_; }
  Vector6 MeanStep(int k, const Vector6& velocity) const { return mean_of_step_[k] * velocity; }

  // Last velocity given the steps: mean = LastMean(v_0) + gain (u - mean of u), covariance.
  Vector6 LastMean(const Vector6& velocity) const { return last_of_first_ * velocity; }
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& gain() const { return gain_; }
  const Matrix6& last_covariance() const { return last_covariance_; }

 private:
  std::vector<Matrix6> mean_of_step_;  // of the first velocity
  Matrix6 last_of_first_;
  Eigen::MatrixXd precision_;
  double log_det_precision_ = 0;
  Eigen::Matrix<double, 6, Eigen::Dynamic> gain_;
  Matrix6 last_covariance_;
};

}  // namespace vo
