#include "vo/map/point_moments.h"

#include "vo/geometry/so3.h"

namespace vo {

Eigen::Matrix3d PointJacobian(const Pose& anchor, const Eigen::Vector3d& landmark) {
  const double rho = landmark.z();
  Eigen::Matrix3d J;
  J << 1, 0, -landmark.x() / rho, 0, 1, -landmark.y() / rho, 0, 0, -1 / rho;
  return anchor.q_WC.toRotationMatrix() * J / rho;
}

Eigen::Matrix<double, 3, 6> PointAnchorJacobian(const Pose& anchor, const Eigen::Vector3d& landmark) {
  const Eigen::Vector3d X_A = Eigen::Vector3d(landmark.x(), landmark.y(), 1) / landmark.z();
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), -anchor.q_WC.toRotationMatrix() * Hat(X_A);
  return J;
}

void PointMixture::Add(double weight, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
  if (weight_ == 0) origin_ = mean;
  const Eigen::Vector3d from_origin = mean - origin_;
  weight_ += weight;
  sum_ += weight * from_origin;
  second_ += weight * (covariance + from_origin * from_origin.transpose());
}

std::optional<PointMoments> PointMixture::Moments() const {
  if (!(weight_ > 0)) return std::nullopt;
  const Eigen::Vector3d mean = sum_ / weight_;
  return PointMoments{origin_ + mean, second_ / weight_ - mean * mean.transpose()};
}

}  // namespace vo
