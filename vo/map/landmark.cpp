#include "vo/map/landmark.h"

#include <cmath>
#include <numbers>

#include "vo/geometry/so3.h"
#include "vo/map/match_lanes.h"

namespace vo {
namespace {

// Match of a landmark that is updated by itself (match_lanes.inc has the same formulas for eight at a time): linearised
// at a landmark `theta` (not at its mean), the landmark's Gaussian integrated out: with the pose moved by d,
//   z - h = e - J_pose d + noise of covariance S = J P J' + R, and the landmark's mode is mean + gain (e - J_pose d).
// Written out by rows (0: x, 1: y).
struct LinearisedMatch {
  bool in_front = false;  // the rest is valid only then
  double e0 = 0, e1 = 0;
  Eigen::Vector3d J0, J1;            // of the landmark
  Eigen::Vector3d P0, P1;            // columns of P J'
  double W00 = 0, W01 = 0, W11 = 0;  // S^-1
  double det_S = 1;
  Eigen::Vector3d gain0, gain1;  // columns of P J' S^-1
  double cost() const { return W00 * e0 * e0 + 2.0 * W01 * e0 * e1 + W11 * e1 * e1; }

  void Set(const AnchorView& view, const Landmark& landmark, const Eigen::Vector3d& theta, const Match& match) {
    const Eigen::Matrix3d& M = view.R_CA;
    const Eigen::Vector3d& t = view.t_C;
    const Eigen::Vector3d X = M.col(0) * theta.x() + M.col(1) * theta.y() + M.col(2) + theta.z() * t;
    in_front = X.z() > kMinDepth;
    if (!in_front) return;
    const double iz = 1.0 / X.z(), u = X.x() * iz, v = X.y() * iz, u_iz = u * iz, v_iz = v * iz;
    J0 = {iz * M(0, 0) - u_iz * M(2, 0), iz * M(0, 1) - u_iz * M(2, 1), iz * t.x() - u_iz * t.z()};
    J1 = {iz * M(1, 0) - v_iz * M(2, 0), iz * M(1, 1) - v_iz * M(2, 1), iz * t.y() - v_iz * t.z()};
    const Eigen::Vector3d off = landmark.mean - theta;
    e0 = match.z.x() - u - J0.dot(off);
    e1 = match.z.y() - v - J1.dot(off);
    P0 = landmark.covariance * J0;
    P1 = landmark.covariance * J1;
    const double S00 = J0.dot(P0) + match.R(0, 0), S01 = J0.dot(P1) + match.R(0, 1),
                 S11 = J1.dot(P1) + match.R(1, 1);  // (3)
    det_S = S00 * S11 - S01 * S01;
    const double scale = 1.0 / det_S;
    W00 = scale * S11;
    W01 = -scale * S01;
    W11 = scale * S00;
    gain0 = P0 * W00 + P1 * W01;
    gain1 = P0 * W01 + P1 * W11;
  }
};

}  // namespace

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

LandmarkUpdate UpdateLandmark(const Landmark& prior, const Eigen::Vector3d& guess, const AnchorView& view,
                              const Match& match, int max_iterations) {
  LandmarkUpdate result{prior, 0};
  LinearisedMatch h;
  Eigen::Vector3d theta = guess;
  for (int i = 0; i < max_iterations; ++i) {
    h.Set(view, prior, theta, match);
    if (!h.in_front) break;
    result.landmark.mean = prior.mean + h.gain0 * h.e0 + h.gain1 * h.e1;
    const Eigen::Vector3d d = result.landmark.mean - theta;
    const double step0 = h.J0.dot(d), step1 = h.J1.dot(d);
    if (step0 * step0 + step1 * step1 < kLandmarkSettled) break;
    theta = result.landmark.mean;
  }
  if (!h.in_front) return {prior, 0};
  // At the mode this is Laplace's approximation of log p(z | pose): r'R^-1 r + (theta - prior)'P^-1(theta - prior) =
  // e'S^-1 e.
  result.log_likelihood = -0.5 * h.cost() - 0.5 * std::log(h.det_S) - std::log(2 * std::numbers::pi);
  // P - P J' S^-1 J P. One pixel takes away at most a factor of 1e6 of a variance: rounding leaves ten digits.
  Eigen::Matrix3d& P = result.landmark.covariance;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) P(i, j) = P(j, i) = P(i, j) - h.P0[i] * h.gain0[j] - h.P1[i] * h.gain1[j];
  return result;
}

}  // namespace vo
