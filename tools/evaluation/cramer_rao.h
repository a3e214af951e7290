// Purpose: how small can errors be? The posterior Cramer-Rao bound of pose and velocity from points seen by a moving
//          camera, given the measurements up to each frame.
// Source:  P. Tichavsky, C. Muravchik, A. Nehorai, "Posterior Cramer-Rao bounds for discrete-time nonlinear filtering",
//          IEEE Trans. Signal Processing 1998; Jacobians taken at one true trajectory, as M. Taylor 1979 does: the
//          covariance of the exact Kalman filter of the world linearised at the truth. docs/metrics.md says what this
//          bounds and what not.
//
// Model: p, v and (delta, w) per axis nearly constant velocity, q_t = q_t-1 Exp(delta); a point anchored where it was
// first seen, with ray (x, y, 1) and inverse depth rho, is at X_C ~ R_CW (rho (p_a - p) + R_Wa ray), seen at X_C / Z
// with Gaussian noise. Its ray is known from the first view, with the noise of that; its inverse depth has a prior.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/evaluation/consistency.h"
#include "tools/evaluation/estimate_run.h"
#include "tools/evaluation/trajectory.h"

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

// Covariance (dp in W, dphi in C, dv in W, dw in C) at each frame given the measurements up to and at it. Throws
// InputError listing what is wrong with the problem (an index beyond the last frame, a point behind the camera, ...).
std::vector<Matrix12d> FilteringBound(const PointWorldProblem& problem);

// The exact Kalman filter of the world linearised at the truth, run `runs` times: errors[run][frame], whose covariance
// is the bound and whose dependence over time is that of an honest filter. For SharesOfPool.
struct LinearisedRuns {
  std::vector<Matrix12d> bound;               // per frame
  std::vector<std::vector<Vector12d>> error;  // [run][frame]
};
LinearisedRuns SimulateLinearised(const PointWorldProblem& problem, int runs, std::uint64_t seed = 1);

// NEES[run][frame] of these errors; NaN where the bound is singular (a start known exactly).
std::vector<std::vector<double>> NeesOf(const LinearisedRuns& runs, int start, int size);

// One step of the pieces, for tests: the Jacobians that the bound is made of.
struct MotionJacobian {
  Matrix12d F, Q;  // at the true increment of orientation
};
MotionJacobian LinearisedMotion(const StampedPose& from, const StampedPose& to, double position_noise,
                                double orientation_noise);

// Root mean square of errors against the bound, over runs: sqrt(sum |e|^2 / sum tr B) per block (p, phi, v, w).
struct BoundRatio {
  std::vector<std::array<double, 4>> per_frame;  // NaN where no run has a bound above zero
  std::array<double, 4> overall{};               // over all frames and runs
  std::array<double, 4> rmse{}, bound{};         // overall, root mean square [m, rad, m/s, rad/s]
};
// errors[run][frame], bounds[run][frame].
BoundRatio CompareWithBound(const std::vector<std::vector<Vector12d>>& errors,
                            const std::vector<std::vector<Matrix12d>>& bounds);

}  // namespace evaluation
