// Scale ambiguity of one camera, added to a filter's answer. All lengths from the start position have an unknown common
// factor exp(-eta), eta ~ N(0, s^2); images and angles are invariant to it, so that the filter can ignore it. The
// filter's own covariance is over-confident here: it treats the depth priors as independent.
// Source:  log-normal moments: E exp(-eta) = exp(s^2 / 2), E exp(-2 eta) = exp(2 s^2). A length x with covariance P has
//          the second moment exp(2 s^2) P + (exp(2 s^2) - 2 exp(s^2 / 2) + 1) x x' about x.
// Units:   metres, in W; covariances of (dp in W, dphi in C, dv in W, dw in C).
#pragma once

#include <Eigen/Core>

#include "vo/base/result.h"
#include "vo/filter/mixture.h"

namespace vo {

class ScaleAmbiguity {
 public:
  // `sigma`: s, LandmarkParams::scale_sigma; 0: the scale is known, nothing changes. `start`: first camera position.
  ScaleAmbiguity(double sigma, const Eigen::Vector3d& start);

  bool known() const { return square_ == 1; }
  // The filter has re-estimated its path, all lengths times `factor`. The answer keeps its scale, unless it is known.
  void AbsorbChange(double factor);
  Pose ToAnswer(const Pose& pose) const;
  Vector6 ToAnswer(const Vector6& velocity) const;
  Eigen::Vector3d ToAnswer(const Eigen::Vector3d& point) const;
  double InverseToAnswer(double inverse_length) const { return inverse_length / scale_; }
  // Of a pose and velocity.
  Matrix12 Covariance(const Pose& pose, const Vector6& velocity, const Matrix12& covariance) const;
  // Component i of a mixture with moments `belief`, so that the moments of the answered mixture are the answer:
  //   x_i -> E exp(-eta) x_i + (1 - E exp(-eta)) x,  P_i -> Covariance(x, P_i) + Var exp(-eta) (x_i x_i' - x x').
  BeliefComponent ToAnswer(const BeliefComponent& component, const Belief& belief) const;
  PointMoments Moments(const PointMoments& point) const;
  // Of an inverse length with this mean and standard deviation.
  double InverseDepthSigma(double mean, double sigma) const;

 private:
  Eigen::Matrix<double, 12, 1> Lengths(const Pose& pose, const Vector6& velocity) const;

  Eigen::Vector3d start_;
  double mean_, square_;  // E exp(-eta), E exp(-2 eta)
  double spread_;         // E (exp(-eta) - 1)^2
  double scale_ = 1;      // length in the answer over length in the filter
};

}  // namespace vo
