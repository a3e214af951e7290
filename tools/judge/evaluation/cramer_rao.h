// Posterior Cramer-Rao bound of pose and velocity from the points that a moving camera has observed up to each frame.
// Source: P. Tichavsky, C. Muravchik, A. Nehorai, "Posterior Cramer-Rao bounds for discrete-time nonlinear filtering",
// IEEE Trans. Signal Processing 1998. Jacobians are taken at one true trajectory, as in M. Taylor 1979: the covariance
// of the exact Kalman filter of the world linearised at the truth. Scope of the bound: docs/metrics.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/judge/evaluation/point_problem.h"

namespace evaluation {

// The exact Kalman filter of the world linearised at the truth, run `runs` times: errors[run][frame], whose covariance
// is the bound and whose dependence over time is that of a consistent filter. For ExactAneesOfPool.
struct LinearisedRuns {
  // Covariance (dp in W, dphi in C, dv in W, dw in C) at each frame given the measurements up to and at it.
  std::vector<Matrix12d> bound;
  std::vector<std::vector<Vector12d>> error;  // [run][frame]
};
// No runs: the bound alone. Throws InputError listing every problem of the input (an index beyond the last frame, a
// point behind the camera, ...).
LinearisedRuns SimulateLinearised(const PointWorldProblem& problem, int runs, std::uint64_t seed = 1);

// NEES[run][frame] of these errors; NaN where the bound is singular (a start known exactly).
std::vector<std::vector<double>> NeesOf(const LinearisedRuns& runs, int start, int size);

// Ratio of RMS errors to the RMS of the bound, statistical efficiency, over frames and runs, per block (p, phi, v, w).
struct BoundRatio {
  std::array<double, 4> overall{};        // sqrt(sum |e|^2 / sum tr B); NaN where no bound is above zero
  std::array<double, 4> rmse{}, bound{};  // root mean square [m, rad, m/s, rad/s]
};
// errors[run][frame], bounds[run][frame]. Throws std::logic_error where they are not as many.
BoundRatio CompareWithBound(const std::vector<std::vector<Vector12d>>& errors,
                            const std::vector<std::vector<Matrix12d>>& bounds);

}  // namespace evaluation
