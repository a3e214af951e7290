// Normal equations of a path window: information on the poses, each landmark eliminated by its Schur complement.
// A d = b with A = sum J'WJ - Y Y' + Z Z', b = sum J'W e - Y y; Y: whitened couplings of the landmarks, Z: gradients of
// the marginal mode.
// Shapes:  6m x 6m for m poses, in the order of path_window.h.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "vo/filter/path_gaussian.h"
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
  Eigen::Matrix2d wander = Eigen::Matrix2d::Zero();  // per view; R contains it from the first view of the window on
  bool provisional = false;  // the landmark follows the poses and does not act on them; behind all others

  // Slots of the poses that it couples: from the first view or the anchor to the last view. Empty without views.
  int first_slot() const {
    if (views.empty()) return 0;
    return anchor_slot < 0 ? views.front().slot : std::min(anchor_slot, views.front().slot);
  }
  int end_slot() const { return views.empty() ? 0 : views.back().slot + 1; }
};

// Sampled state of one particle, from which its window begins.
struct WindowInput {
  const Pose& start;        // the last sampled pose
  const Vector6& velocity;  // mean at the start
  std::span<const Landmark> landmarks;
  std::span<const Pose> anchors;  // those of the window are not read
};

// The anchor's pose on the particle's path, sampled or not.
inline const Pose& AnchorOn(const PathGaussian& path, const WindowInput& in, const Track& track) {
  return track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
}

// A window linearised at one particle's path, each landmark as a standard normal u with theta = mean + L u.
struct PathLinearisation {
  struct View {
    bool used = false;  // in front
    Matrix23 J_landmark, WM;
    Eigen::Matrix<double, 6, 2> JtW, AtW;
  };
  struct Eliminated {
    Eigen::Matrix3d L;
    Eigen::LLT<Eigen::Matrix3d> G;  // information of u given the poses
    Eigen::Matrix3d U_inverse;      // of its upper factor
    bool used = false;
    Eigen::Index row, end;  // of its columns of Y: the other rows are 0
  };
  Eigen::MatrixXd J;                  // of the steps u: du_k / d(pose k-1), du_k / d(pose k), per step 6 x 12
  std::vector<View> views;            // in the order of the tracks
  std::vector<Eliminated> landmarks;  // per track
  Eigen::MatrixXd Y;                  // whitened couplings of poses and landmarks, 3 columns per track
  Eigen::Index acting = 0;            // columns of the tracks that act on the poses, the first
};

// The prior's share of b, and of the cost, which is returned; `J` of the steps.
double SetPriorGradient(const PathPrior& prior, const WindowInput& in, const PathGaussian& path,
                        const Eigen::MatrixXd& J, Eigen::VectorXd& b);

class PathEquations {
 public:
  // A window, then its linearisations: the prior alone, then each track in turn.
  void Begin(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks);
  void AddPrior(const PathPrior& prior, const WindowInput& in, const PathGaussian& path);
  void AddTrack(std::size_t index, const WindowInput& in, const Track& track, const PathGaussian& path,
                const Eigen::Vector3d& theta, bool marginal);
  // Takes the landmarks' share out of b, then out of A.
  void ReduceGradient();
  void ReduceInformation();

  // The anchor from the view's camera, by the rotations of AddPrior.
  AnchorView ViewOf(const Track::View& view, const PathGaussian& path, const Eigen::Matrix3d& R_WA,
                    const Eigen::Vector3d& anchor_W) const {
    return {rotations_[view.slot], path.mean[view.slot].p_WC + view.centre_offset_W, R_WA, anchor_W};
  }
  const PathLinearisation& linearisation() const { return linear_; }
  const Eigen::MatrixXd& A() const { return A_; }  // lower triangle, when reduced
  const Eigen::VectorXd& b() const { return b_; }
  double cost() const { return cost_; }  // constant part of -2 log of the evidence's exponent
  double log_det() const { return log_det_; }
  int behind_camera() const { return behind_camera_; }

  // Landmarks follow the poses' step to first order: theta = mean + L u. Those without a view in front stay.
  void MoveLandmarks(const Eigen::VectorXd& step, const WindowInput& in, std::span<const Track> tracks,
                     std::vector<Eigen::Vector3d>& theta);

 private:
  struct Seen {
    int slot = 0;
    Matrix23 J_shift, WM;
    Eigen::Matrix2d R_inverse;
  };
  void AddMarginal(const Track& track, const PathLinearisation::Eliminated& landmark, double rho);

  PathLinearisation linear_;
  std::vector<Eigen::Matrix3d> rotations_;  // R_CW of the poses
  Eigen::MatrixXd A_;
  Eigen::VectorXd b_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd Z_;
  Eigen::Index z_columns_ = 0;  // in use; three of Y for each, behind the tracks'
  std::vector<Seen> seen_;      // of the present track
  double cost_ = 0, log_det_ = 0;
  int behind_camera_ = 0;
};

}  // namespace vo
