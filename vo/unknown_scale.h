// Purpose: what nobody can know of the scale, on top of what a filter says. One camera sees everything but the scale; a filter that takes the
//          prior of each depth at its word believes to know it to that prior's sigma over the root of the number of landmarks. What is known is rather that all lengths,
//          seen from where the camera started, have a factor exp(-eta) in common, eta ~ N(0, sigma^2). Images and angles do not hang on it, so that
//          no filter needs to know: second moments about its answer are those of the mixture over eta, in closed form.
// Source:  moments of the log-normal distribution: E exp(-eta) = exp(s^2 / 2), E exp(-2 eta) = exp(2 s^2). A length x with covariance P becomes
//          exp(-eta) x: about x its second moment is exp(2 s^2) P + (exp(2 s^2) - 2 exp(s^2 / 2) + 1) x x'.
// Units:   metres, in W; covariances of (dp in W, dphi in C, dv in W, dw in C).
#pragma once

#include <Eigen/Core>

#include "vo/filter/mixture.h"
#include "vo/map/point_moments.h"

namespace vo {

class UnknownScale {
 public:
  // `sigma`: of eta, LandmarkParams::scale_sigma; 0: the scale is known, and nothing changes. `start`: the camera's first place.
  UnknownScale(double sigma, const Eigen::Vector3d& start);

  bool known() const { return square_ == 1; }
  // The filter has found its path anew, with all lengths times `factor`: where the scale is not known that tells nothing of it, and what is
  // answered keeps the scale of what was answered before.
  void Lengthened(double factor);
  Pose Answered(const Pose& pose) const;
  Vector6 Answered(const Vector6& velocity) const;
  Eigen::Vector3d Answered(const Eigen::Vector3d& point) const;
  double AnsweredInverse(double inverse_length) const { return inverse_length / kept_; }
  // The covariance of a pose and velocity.
  Matrix12 Covariance(const Pose& pose, const Vector6& velocity, const Matrix12& covariance) const;
  // A component of a mixture with the moments `belief`, so that those of what is answered are the answer's. A component at x_i becomes one at
  // E exp(-eta) x_i, its covariance wider by Var exp(-eta) x_i x_i'. The answer stays where the mixture's mean x was, so all are moved by
  // (1 - E exp(-eta)) x, and that is in their covariance, too.
  BeliefComponent Answered(const BeliefComponent& component, const Belief& belief) const;
  PointMoments Moments(const PointMoments& point) const;
  // Of an inverse length and its standard deviation.
  double InverseDepthSigma(double mean, double sigma) const;

 private:
  Eigen::Matrix<double, 12, 1> Lengths(const Pose& pose, const Vector6& velocity) const;

  Eigen::Vector3d start_;
  double factor_, square_;  // expected exp(-eta), and its square's
  double off_;              // expected (exp(-eta) - 1)^2
  double kept_ = 1;         // of a length of the filter's, to one that is answered
};

}  // namespace vo
