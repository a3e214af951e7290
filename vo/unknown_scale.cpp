#include "vo/unknown_scale.h"

#include <cmath>

namespace vo {

UnknownScale::UnknownScale(double sigma, const Eigen::Vector3d& start)
    : start_(start),
      factor_(std::exp(sigma * sigma / 2)),
      square_(std::exp(2 * sigma * sigma)),
      off_(square_ - 2 * factor_ + 1) {}

void UnknownScale::Lengthened(double factor) {
  if (!known()) kept_ /= factor;
}

Eigen::Vector3d UnknownScale::Answered(const Eigen::Vector3d& point) const {
  return kept_ == 1 ? point : Eigen::Vector3d(start_ + kept_ * (point - start_));
}

Pose UnknownScale::Answered(const Pose& pose) const { return {Answered(pose.p_WC), pose.q_WC}; }

Vector6 UnknownScale::Answered(const Vector6& velocity) const {
  Vector6 answered = velocity;
  answered.head<3>() *= kept_;
  return answered;
}

// As they are answered, seen from the start; zero where there are angles.
Eigen::Matrix<double, 12, 1> UnknownScale::Lengths(const Pose& pose, const Vector6& velocity) const {
  Eigen::Matrix<double, 12, 1> length = Eigen::Matrix<double, 12, 1>::Zero();
  length.segment<3>(0) = pose.p_WC - start_;
  length.segment<3>(6) = velocity.head<3>();
  return kept_ * length;
}

Matrix12 UnknownScale::Covariance(const Pose& pose, const Vector6& velocity, const Matrix12& covariance) const {
  if (known()) return covariance;
  const Eigen::Matrix<double, 12, 1> length = Lengths(pose, velocity);
  Matrix12 wide = off_ * length * length.transpose();
  for (int row = 0; row < 12; row += 3) {
    for (int column = 0; column < 12; column += 3) {
      const int lengths = (row % 6 == 0) + (column % 6 == 0);
      wide.block<3, 3>(row, column) += (lengths == 0   ? 1
                                        : lengths == 1 ? kept_ * factor_
                                                       : kept_ * kept_ * square_) *
                                       covariance.block<3, 3>(row, column);
    }
  }
  return wide;
}

BeliefComponent UnknownScale::Answered(const BeliefComponent& component, const Belief& belief) const {
  if (known()) return component;
  const Eigen::Matrix<double, 12, 1> length = Lengths(component.pose, component.velocity),
                                     mean = Lengths(belief.pose, belief.velocity);
  const Eigen::Matrix<double, 12, 1> outwards = (factor_ - 1) * (length - mean);
  BeliefComponent answered = component;
  answered.pose.p_WC = Answered(component.pose.p_WC) + outwards.segment<3>(0);
  answered.velocity.head<3>() = Answered(component.velocity).head<3>() + outwards.segment<3>(6);
  // off_ is Var exp(-eta) + (1 - E exp(-eta))^2
  answered.covariance = Covariance(belief.pose, belief.velocity, component.covariance) +
                        (square_ - factor_ * factor_) * (length * length.transpose() - mean * mean.transpose());
  return answered;
}

PointMoments UnknownScale::Moments(const PointMoments& point) const {
  const Eigen::Vector3d length = kept_ * (point.mean - start_);
  return {Answered(point.mean), kept_ * kept_ * square_ * point.covariance + off_ * length * length.transpose()};
}

double UnknownScale::InverseDepthSigma(double mean, double sigma) const {
  return std::sqrt(square_ * sigma * sigma + off_ * mean * mean) / kept_;
}

}  // namespace vo
