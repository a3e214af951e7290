// Point world as an estimation problem: parameters, and Jacobians of motion and measurement at the truth.
// Source: docs/metrics.md, "The Cramer-Rao bound". Independent of simulator and filter, tested against finite
// differences.
//
// Model: p, v and (delta, w) per axis nearly constant velocity, q_t = q_t-1 Exp(delta); a point anchored where it was
// first seen, with ray (x, y, 1) and inverse depth rho, is at X_C ~ R_CW (rho (p_a - p) + R_Wa ray), seen at X_C / Z
// with Gaussian noise. Its ray is known from the first view, with the noise of that; its inverse depth has a prior.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/judge/evaluation/consistency.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

struct PointLandmark {
  std::size_t anchor_frame = 0;       // of its first view
  Eigen::Vector2d ray{0, 0};          // true (x, y) on the plane z = 1 of that camera
  double inverse_depth = 0;           // true [1/m]; 0 and less are allowed (seen, but behind infinity)
  double inverse_depth_sigma = 0.15;  // of the prior [1/m]; 0: known
  std::vector<std::size_t> frames;    // at which it is measured again, ascending, after anchor_frame. After the
                                      // last of them it is forgotten: one found again later is another landmark
};

struct PointWorldProblem {
  Trajectory truth;  // pose per frame, stamps strictly ascending
  std::vector<PointLandmark> landmarks;
  double sigma = 1.0 / 525;         // of a measurement, per axis, on the plane z = 1: pixels / focal length
  double anchor_sigma = 1.0 / 525;  // of the first view; 0: the ray is known
  double position_noise = 2.5;      // square root of the power spectral density of acceleration [m/s^1.5]
  double orientation_noise = 1.0;   // the same of angular acceleration [rad/s^1.5]
  Matrix12d start_covariance = Matrix12d::Zero();  // of (dp, dphi, dv, dw) at frame 0, before its measurements
};

// Throws InputError listing every problem: an index beyond the last frame, a point behind the camera, ...
void Validate(const PointWorldProblem& problem);

// State error (dp, dphi, dv, dw) from one frame to the next: e_t = F e_t-1 + noise of covariance Q, linearised at the
// true change of orientation.
struct MotionJacobian {
  Matrix12d F, Q;
};
MotionJacobian LinearisedMotion(const StampedPose& from, const StampedPose& to, double position_noise,
                                double orientation_noise);

// A point as the homogeneous (X, rho), X = rho p_a + R_a ray, of which only the direction is observable: its image is
// along R_CW (X - rho p). Measurements depend on the three error components across the true direction only; expressed
// in these the point no longer needs its anchor's pose, and rho = 0 is not singular.
struct HomogeneousPoint {
  Eigen::Vector4d direction;           // (X, rho), true
  Eigen::Matrix<double, 3, 4> across;  // orthonormal rows, at right angles to it
};
HomogeneousPoint PointOf(const PointLandmark& landmark, const StampedPose& anchor);

// Of (X, rho), with respect to the anchor's (dp, dphi) and to (x, y, rho).
struct AnchorJacobian {
  Eigen::Matrix<double, 4, 6> of_pose;
  Eigen::Matrix<double, 4, 3> of_landmark;
};
AnchorJacobian LinearisedAnchor(const PointLandmark& landmark, const StampedPose& anchor);

// Of the point on the plane z = 1, with respect to the camera's (dp, dphi) and to (X, rho).
struct ViewJacobian {
  Eigen::Vector2d seen;
  double depth = 0;  // times rho; above 0 in front of the camera
  Eigen::Matrix<double, 2, 6> of_pose;
  Eigen::Matrix<double, 2, 4> of_point;
};
ViewJacobian LinearisedView(const HomogeneousPoint& point, const StampedPose& pose);

}  // namespace evaluation
