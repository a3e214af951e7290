#include "vo/map/landmark.h"

#include <cmath>

#include "vo/geometry/so3.h"

namespace vo {

Projection Project(const AnchorView& view, const Eigen::Vector3d& landmark) {
  const double rho = landmark.z();
  const Eigen::Vector3d X = view.R_CA * Eigen::Vector3d(landmark.x(), landmark.y(), 1.0) + rho * view.t_C;
  Projection p;
  if (X.z() <= kMinDepth) return p;
  p.in_front = true;
  const double iz = 1.0 / X.z();
  p.z = X.head<2>() * iz;
  Matrix23 J_X;  // dz / dX
  J_X << iz, 0, -p.z.x() * iz, 0, iz, -p.z.y() * iz;
  p.J_shift = J_X * view.R_CW;
  p.J_pose.leftCols<3>() = -rho * p.J_shift;
  p.J_pose.rightCols<3>() = J_X * Hat(X);
  p.J_landmark.leftCols<2>() = J_X * view.R_CA.leftCols<2>();
  p.J_landmark.col(2) = J_X * view.t_C;
  return p;
}

Match AtStamp(const Match& match, const AnchorView& view, const Eigen::Vector3d& theta) {
  if (match.centre_offset_W.isZero(0)) return match;
  const Projection there = Project(view.ShiftedBy(match.centre_offset_W), theta), here = Project(view, theta);
  if (!there.in_front || !here.in_front) return match;
  Match at_stamp = match;
  at_stamp.z += here.z - there.z;
  at_stamp.centre_offset_W.setZero();
  return at_stamp;
}

Matrix26 AnchorJacobian(const Projection& projection, const Eigen::Vector3d& landmark) {
  const Matrix23& J = projection.J_landmark;
  Matrix23 J_ray;  // dz / d(ray in A). J_X X = 0, so its product with the ray (x, y, 1) is -rho dz/drho.
  J_ray.leftCols<2>() = J.leftCols<2>();
  J_ray.col(2) = -J * landmark;
  Matrix26 result;
  result.leftCols<3>() = -projection.J_pose.leftCols<3>();
  result.rightCols<3>() = -J_ray * Hat({landmark.x(), landmark.y(), 1.0});
  return result;
}

RowView::Compensated RowView::RotationCompensated(const Vector6& velocity) const {
  if (time == 0) return {z, Eigen::Vector3d::Zero()};
  return {(Exp(time * velocity.tail<3>()) * z.homogeneous()).hnormalized(), time * velocity.head<3>()};
}

FirstView FirstSeen(const RowView& row, const Pose& pose, const Vector6& velocity) {
  const auto [ray, centre_offset_W] = row.RotationCompensated(velocity);
  FirstView view{ray, Eigen::Matrix2d::Zero()};
  view.d_ray_d_rho = Project({pose, pose}, {ray.x(), ray.y(), 1.0}).J_shift * centre_offset_W;
  view.row = row;
  return view;
}

Landmark NewLandmark(const FirstView& view, const LandmarkParams& params) {
  const double rho = view.depth ? view.depth->inverse_depth : params.inverse_depth;
  const double sigma = view.depth ? view.depth->sigma : params.inverse_depth_sigma;
  Landmark landmark;
  landmark.mean << view.ray + rho * view.d_ray_d_rho, rho;
  landmark.covariance(2, 2) = sigma * sigma;
  if (params.bearing == Bearing::fixed) return landmark;
  const Eigen::Vector2d coupling = sigma * sigma * view.d_ray_d_rho;
  landmark.covariance.topLeftCorner<2, 2>() = view.R + coupling * view.d_ray_d_rho.transpose();
  landmark.covariance.topRightCorner<2, 1>() = coupling;
  landmark.covariance.bottomLeftCorner<1, 2>() = coupling.transpose();
  return landmark;
}

Eigen::Vector3d PointInWorld(const Pose& anchor, const Eigen::Vector3d& landmark) {
  const double rho = std::abs(landmark.z()) < 1e-6 ? 1e-6 : landmark.z();
  return anchor.p_WC + anchor.q_WC * Eigen::Vector3d(landmark.x(), landmark.y(), 1.0) / rho;
}

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

}  // namespace vo
