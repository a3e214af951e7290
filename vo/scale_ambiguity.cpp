#include "vo/scale_ambiguity.h"

#include <cmath>

namespace vo {

ScaleAmbiguity::ScaleAmbiguity(double sigma, const Eigen::Vector3d& start)
    : start_(start),
      mean_(std::exp(sigma * sigma / 2)),
      square_(std::exp(2 * sigma * sigma)),
      spread_(square_ - 2 * mean_ + 1) {}

void ScaleAmbiguity::AbsorbChange(double factor) {
  if (!known()) scale_ /= factor;
}

Eigen::Vector3d ScaleAmbiguity::ToAnswer(const Eigen::Vector3d& point) const {
  return scale_ == 1 ? point : Eigen::Vector3d(start_ + scale_ * (point - start_));
}

Pose ScaleAmbiguity::ToAnswer(const Pose& pose) const { return {ToAnswer(pose.p_WC), pose.q_WC}; }

Vector6 ScaleAmbiguity::ToAnswer(const Vector6& velocity) const {
  Vector6 answered = velocity;
  answered.head<3>() *= scale_;
  return answered;
}

// x of the answer: lengths from the start, zero for angles.
Eigen::Matrix<double, 12, 1> ScaleAmbiguity::Lengths(const Pose& pose, const Vector6& velocity) const {
  Eigen::Matrix<double, 12, 1> length = Eigen::Matrix<double, 12, 1>::Zero();
  length.segment<3>(0) = pose.p_WC - start_;
  length.segment<3>(6) = velocity.head<3>();
  return scale_ * length;
}

Matrix12 ScaleAmbiguity::Covariance(const Pose& pose, const Vector6& velocity, const Matrix12& covariance) const {
  if (known()) return covariance;
  const Eigen::Matrix<double, 12, 1> length = Lengths(pose, velocity);
  Matrix12 wide = spread_ * length * length.transpose();
  for (int row = 0; row < 12; row += 3) {
    for (int column = 0; column < 12; column += 3) {
      const int lengths = (row % 6 == 0) + (column % 6 == 0);
      wide.block<3, 3>(row, column) += (lengths == 0   ? 1
                                        : lengths == 1 ? scale_ * mean_
                                                       : scale_ * scale_ * square_) *
                                       covariance.block<3, 3>(row, column);
    }
  }
  return wide;
}

BeliefComponent ScaleAmbiguity::ToAnswer(const BeliefComponent& component, const Belief& belief) const {
  if (known()) return component;
  const Eigen::Matrix<double, 12, 1> length = Lengths(component.pose, component.velocity),
                                     mean = Lengths(belief.pose, belief.velocity);
  const Eigen::Matrix<double, 12, 1> shift = (mean_ - 1) * (length - mean);
  BeliefComponent answered = component;
  answered.pose.p_WC = ToAnswer(component.pose.p_WC) + shift.segment<3>(0);
  answered.velocity.head<3>() = ToAnswer(component.velocity).head<3>() + shift.segment<3>(6);
  // spread_ = Var exp(-eta) + (1 - E exp(-eta))^2
  answered.covariance = Covariance(belief.pose, belief.velocity, component.covariance) +
                        (square_ - mean_ * mean_) * (length * length.transpose() - mean * mean.transpose());
  return answered;
}

PointMoments ScaleAmbiguity::Moments(const PointMoments& point) const {
  const Eigen::Vector3d length = scale_ * (point.mean - start_);
  return {ToAnswer(point.mean), scale_ * scale_ * square_ * point.covariance + spread_ * length * length.transpose()};
}

double ScaleAmbiguity::InverseDepthSigma(double mean, double sigma) const {
  return std::sqrt(square_ * sigma * sigma + spread_ * mean * mean) / scale_;
}

}  // namespace vo
