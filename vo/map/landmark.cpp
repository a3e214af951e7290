#include "vo/map/landmark.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr double kMinDepth = 1e-6;   // of rho-scaled points; in front of the camera
constexpr double kSettled = 1e-16;   // squared step on the plane z = 1: 1e-8, far below a pixel's 1e-3

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

Landmark NewLandmark(const Eigen::Vector2d& ray, const Eigen::Matrix2d& R, const LandmarkParams& params) {
  Landmark landmark;
  landmark.mean << ray, params.inverse_depth;
  if (params.bearing == Bearing::estimated) landmark.covariance.topLeftCorner<2, 2>() = R;
  landmark.covariance(2, 2) = params.inverse_depth_sigma * params.inverse_depth_sigma;
  return landmark;
}

Eigen::Vector3d PointInWorld(const Pose& anchor, const Eigen::Vector3d& landmark) {
  const double rho = std::abs(landmark.z()) < 1e-6 ? 1e-6 : landmark.z();
  return anchor.p_WC + anchor.q_WC * Eigen::Vector3d(landmark.x(), landmark.y(), 1.0) / rho;
}

LandmarkUpdate UpdateLandmarkAt(const Landmark& prior, const Eigen::Vector3d& mode, const AnchorView& view, const Match& match) {
  LandmarkUpdate result{prior, 0};
  const Projection h = Project(view, mode);
  result.behind = !h.in_front;
  if (result.behind) return result;
  const Eigen::Matrix3d& P = prior.covariance;
  const Matrix23& J = h.J_landmark;
  const Eigen::Vector2d e = match.z - h.z - J * (prior.mean - mode);  // innovation, linearised at the mode
  const Eigen::Matrix2d S = J * P * J.transpose() + match.R;          // (3)
  const Eigen::Matrix2d S_inverse = S.inverse();
  const Eigen::Matrix<double, 3, 2> gain = P * J.transpose() * S_inverse;
  // At the mode this is Laplace's approximation of log p(z | pose): r'R^-1 r + (theta - prior)'P^-1(theta - prior) = e'S^-1 e.
  result.log_likelihood = -0.5 * e.dot(S_inverse * e) - 0.5 * std::log(S.determinant()) - std::log(2 * std::numbers::pi);
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - gain * J;
  result.landmark.mean = prior.mean + gain * e;
  result.landmark.covariance = A * P * A.transpose() + gain * match.R * gain.transpose();  // Joseph
  result.settled = (J * (result.landmark.mean - mode)).squaredNorm() < kSettled;
  return result;
}

LandmarkUpdate UpdateLandmark(const Landmark& prior, const AnchorView& view, const Match& match, int max_iterations) {
  LandmarkUpdate result{prior, 0};
  for (int i = 0; i < max_iterations && !result.settled; ++i) {
    const LandmarkUpdate next = UpdateLandmarkAt(prior, result.landmark.mean, view, match);
    if (next.behind) break;
    result = next;
  }
  return result;
}

}  // namespace vo
