// Normalised estimation error squared (NEES): e' P^-1 e, per frame and over runs.
// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation", 5.4.
//
// Errors are never aligned: an alignment fitted to the whole run makes a consistent filter look over-confident early
// and under-confident at the end (docs/metrics.md). Order of the covariance: dp = p - p^ in W, dphi = Log(q^^-1 q) in
// C, dv = v - v^ in W, dw = w - w^ in C; truth minus estimate (^).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

using Vector12d = Eigen::Matrix<double, 12, 1>;

// World frame of the errors.
enum class Gauge {
  as_is,       // the estimate was started in the truth's world
  first_pose,  // it was started elsewhere, at a pose it knew exactly: truth is moved into its world by the first pair
               // of poses. Exact if that truth is; a noisy first truth makes every later NEES too large
};

inline const char* Name(Gauge gauge) { return gauge == Gauge::as_is ? "not aligned" : "the first poses made equal"; }

// One frame that has truth, an estimate and a covariance. NaN where a value is undefined: no true velocity, or a
// covariance that is not positive definite (as of a start known exactly).
struct FrameConsistency {
  std::int64_t stamp_ns = 0;  // of the estimate
  Vector12d error;            // [m, rad, m/s, rad/s]
  Vector12d sigma;            // square roots of the covariance's diagonal
  double nees_pose = 0;       // 6 degrees of freedom
  double nees_velocity = 0;   // 6
  double nees_joint = 0;      // 12
  // Scale-free NEES: the smallest over s of (e - s g)' P^-1 (e - s g), g the direction in which the truth moves when it
  // is scaled about its start: (p - p_start, 0, v, 0). The truth takes on the estimate's scale, so that error and
  // covariance are in the same measure. Of a consistent Gaussian error it is chi-square with one degree less; nothing
  // is fitted across frames. NaN at the start itself, where the scale is unobservable.
  double nees_pose_scale_free = 0;   // 5
  double nees_joint_scale_free = 0;  // 11
};

// e' P^-1 e; NaN when P is not positive definite to working precision.
double Nees(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);
// The smallest value over s for the error e - s g; NaN also when g is zero.
double NeesWithoutDirection(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance,
                            const Eigen::VectorXd& direction);

// Of the answers as given, to which the covariances belong.
std::vector<FrameConsistency> ComputeConsistency(const EstimateRun& run, const Trajectory& truth,
                                                 const std::optional<Velocities>& truth_velocities, std::int64_t gap_ns,
                                                 Gauge gauge = Gauge::as_is);

// NEES of one run. Values of neighbouring frames are strongly dependent: mean and share describe this run; their spread
// needs several runs.
struct NeesSummary {
  int dof = 0;
  std::size_t frames = 0;    // with a value
  std::size_t unusable = 0;  // frames without (see FrameConsistency)
  // NaN without a frame. Ideal: dof, and the chi-square median
  double mean = std::numeric_limits<double>::quiet_NaN(), median = mean;
  double last = mean;
  double share_inside = mean;  // of frames inside the two-sided 95 % band of one run
};

NeesSummary SummariseNees(const std::vector<double>& nees, int dof);

// Average NEES over runs at one frame, and the band of the average of M consistent runs (probability 95 %).
struct AneesPoint {
  std::int64_t stamp_ns = 0;
  int runs = 0;  // with a value at this frame
  double anees = 0;
  Band band;
};

// values[m][k]: NEES of run m at frame k, stamps[m][k] its time; runs are joined by equal stamps. Frames without any
// value are left out.
std::vector<AneesPoint> Anees(const std::vector<std::vector<std::int64_t>>& stamps,
                              const std::vector<std::vector<double>>& values, int dof);
// The same with numbers of frames, from `first` on, in place of stamps.
std::vector<AneesPoint> AneesByFrame(const std::vector<std::vector<double>>& values, int dof, std::int64_t first = 0);

}  // namespace evaluation
