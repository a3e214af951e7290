// Purpose: delayed sampling: the last poses of a particle, not sampled yet, as one Gaussian given the sampled path and every image since.
//          Gauss-Newton over the poses and the landmarks together; each landmark is eliminated by its own Schur complement.
// Source:  algorithm, section 9. With one pose this is Propose (section 3), which is kept because it is faster.
// Tangent: per pose (dp in W, dphi in C); slot 0 is the oldest pose that is not sampled.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "vo/filter/descent.h"
#include "vo/base/numerical_events.h"
#include "vo/filter/path_prior.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/map/image_prediction.h"
#include "vo/map/landmark.h"

namespace vo {

// One landmark seen from the window, the same for all particles. A landmark's first view is its prior, not an observation.
struct Track {
  struct View {
    int slot = 0;
    Eigen::Vector2d z = Eigen::Vector2d::Zero();
    Eigen::Matrix2d R_inverse = Eigen::Matrix2d::Identity();
    double log_det_R = 0;
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();  // as in Match
  };
  int landmark = 0;
  int anchor = 0;        // index of the anchor pose
  int anchor_slot = -1;  // its slot, or -1: it has been sampled
  std::vector<View> views;
};

// What one particle brings in, and its first guess.
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
  double objective = 0;                // -2 log density at its mode, up to a constant that is the same for all guesses
  double log_evidence = 0;             // Laplace's approximation of log p(z in the window | sampled path)
  Guards guards;  // of the solution; where something was not positive definite, the evidence is not a number
};

// u of path_prior.h: of the rotation vectors that turn the pose before into the pose at `slot`, the one nearest to what was predicted.
inline Vector6 StepTo(int slot, const PathGaussian& path, const Pose& start) {
  return MinusNear(path.mean[slot], slot == 0 ? start : path.mean[slot - 1], path.turns[slot]);
}

struct WindowOptions {
  int max_iterations = 10;
  bool marginal = false;  // the mode of the poses' marginal, not of poses and landmarks jointly
  double left = kLeft;    // distance from the mode that may be left [standard deviations]
  double beaten_by = std::numeric_limits<double>::infinity();  // an objective: who will not get below it may stop
};

class PathWindow {
 public:
  // `path.mean` holds the first guess, one pose per step of the prior, and is replaced; `theta` likewise, the mode of each track's
  // landmark in the order of `tracks`.
  void Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks, const WindowOptions& options,
             PathGaussian& path, std::vector<Eigen::Vector3d>& theta);

  // Of a solved window, or one that was extended since (path_end.h): the landmark given its poses, and where it should appear from the last
  // of them (all of them uncertain).
  static Landmark Smoothed(const WindowInput& in, const Track& track, const PathGaussian& path,
                           const Eigen::Vector3d& theta);
  // Covariance of the anchor's pose (dp in W, dphi in C; zero where it has been sampled) and, behind it, the landmark, the poses as uncertain as they are.
  static Eigen::Matrix<double, 9, 9> WithAnchor(const WindowInput& in, const Track& track, const PathGaussian& path,
                                                const Eigen::Vector3d& theta);
  static ImagePrediction PredictLast(const WindowInput& in, const Track& track, const PathGaussian& path,
                                     const Eigen::Vector3d& theta);

 private:
  // One landmark at the present linearisation, as a standard normal u with theta = mean + L u.
  struct Eliminated {
    Eigen::Matrix3d L;
    Eigen::LLT<Eigen::Matrix3d> G;  // information of u given the poses
    Eigen::Matrix3d U_inverse;      // of its upper factor
    bool used = false;
  };
  void AddPrior(const PathPrior& prior, const WindowInput& in, const PathGaussian& path);
  void AddTrack(const WindowInput& in, const Track& track, const PathGaussian& path, const Eigen::Vector3d& theta,
                bool marginal);

  void AddMarginal(const Track& track, const Eliminated& landmark, double rho);

  // Workspace, so that repeated calls allocate nothing.
  Eigen::MatrixXd A_;  // information of the poses
  Eigen::VectorXd b_, d_, r_, step_;
  Eigen::MatrixXd J_;  // of the steps u: du_k / d(pose k-1), du_k / d(pose k), per step 6 x 12
  Eigen::MatrixXd Y_;  // columns: the landmarks' whitened couplings; A -= Y Y'
  Eigen::VectorXd y_;  // b -= Y y
  Eigen::MatrixXd Z_;  // A += Z Z'
  struct Seen {
    int slot = 0;
    Matrix23 J_shift, WM;
    Eigen::Matrix2d R_inverse;
  };
  std::vector<Seen> seen_;           // of the present track
  std::vector<Pose> linearised_at_;  // where the cost was least
  std::vector<Eigen::Vector3d> linearised_theta_;
  int rows_ = 0, columns_ = 0, added_ = 0;
  double cost_ = 0;  // -2 log of the evidence's exponent, constant part
  double log_det_ = 0;
  int behind_ = 0;
  std::vector<Eliminated> eliminated_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace vo
