// Fixed-lag window: the last poses of a particle as one Gaussian given the sampled path and every image since.
// Gauss-Newton over poses and landmarks jointly; each landmark is eliminated by its own Schur complement.
// Source:  docs/algorithm.md, section 9. With one pose this is Propose (section 3), which is faster.
// Tangent: per pose (dp in W, dphi in C); slot 0 is the oldest pose that is not sampled.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "vo/base/numerical_events.h"
#include "vo/filter/gauss_newton.h"
#include "vo/filter/path_prior.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/map/landmark.h"

namespace vo {

// Observations of one landmark in the window, the same for all particles. A landmark's first view is its prior, not an
// observation.
struct Track {
  struct View {
    int slot = 0;
    Eigen::Vector2d z = Eigen::Vector2d::Zero();
    Eigen::Matrix2d R_inverse = Eigen::Matrix2d::Identity();
    double log_det_R = 0;
    Eigen::Vector3d centre_offset_W = Eigen::Vector3d::Zero();  // as in Match
  };
  int landmark = 0;
  int anchor = 0;        // index of the anchor pose
  int anchor_slot = -1;  // its slot, or -1: it has been sampled
  std::vector<View> views;
};

// One particle's committed state.
struct WindowInput {
  const Pose& start;        // the last sampled pose
  const Vector6& velocity;  // mean at the start
  std::span<const Landmark> landmarks;
  std::span<const Pose> anchors;  // those of the window are not read
};

struct PathGaussian {
  std::vector<Pose> mean;
  std::vector<Eigen::Vector3d> turns;  // [rad in C] of the step to each pose, as it was predicted
  Eigen::MatrixXd covariance;          // 6m x 6m
  double objective = 0;                // -2 log density at its mode, up to a constant that all first guesses share
  double log_evidence =
      0;  // Laplace's approximation of log p(z in the window | sampled path); NaN: not positive definite
  NumericalEvents events;  // of the solution
};

// u of path_prior.h: of the rotation vectors that turn the pose before into the pose at `slot`, the one nearest to the
// prediction.
inline Vector6 StepTo(int slot, const PathGaussian& path, const Pose& start) {
  return MinusNear(path.mean[slot], slot == 0 ? start : path.mean[slot - 1], path.turns[slot]);
}

// The anchor's pose on the particle's path, sampled or not.
inline const Pose& AnchorOn(const PathGaussian& path, const WindowInput& in, const Track& track) {
  return track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
}

struct WindowOptions {
  int max_iterations = 10;
  bool marginal = false;  // the mode of the poses' marginal, not of poses and landmarks jointly
  double tolerance_sigma = kToleranceSigma;
  double stop_if_above = std::numeric_limits<double>::infinity();  // an objective, as in Descent
};

// Lower-triangular L with L L' = P; P may be singular (a fixed bearing).
Eigen::Matrix3d LandmarkRoot(const Eigen::Matrix3d& P);

class PathEquations;

class PathWindow {
 public:
  PathWindow();
  ~PathWindow();
  PathWindow(PathWindow&&) noexcept;
  PathWindow& operator=(PathWindow&&) noexcept;
  // Minimises over the window. `path.mean` holds the first guess, one pose for each step of the prior, and is replaced;
  // so is `theta`, the mode of each track's landmark in the order of `tracks`.
  void Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks, const WindowOptions& options,
             PathGaussian& path, std::vector<Eigen::Vector3d>& theta);

 private:
  std::unique_ptr<PathEquations> equations_;  // workspace, so that repeated calls allocate little
};

}  // namespace vo
