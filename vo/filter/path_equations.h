// Normal equations of a path window: information on the poses, each landmark eliminated by its Schur complement.
// A d = b with A = sum J'WJ - Y Y' + Z Z', b = sum J'W e - Y y; Y: whitened couplings of the landmarks, Z: gradients of
// the marginal mode.
// Shapes:  6m x 6m for m poses, in the order of path_window.h; with rates of rows 9 (m + 1).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vo/filter/path_linearisation.h"

namespace vo {

class PathEquations {
 public:
  // A window, then its linearisations: the prior alone, then each track in turn.
  void Begin(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks, Rates rates);
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
                     const PathGaussian& path, std::vector<Eigen::Vector3d>& theta);

 private:
  struct Seen {
    int slot = 0;
    Matrix23 J_shift, WM;
    Eigen::Matrix2d R_inverse;
  };
  template <int kSize>
  void AddTrackOf(std::size_t index, const WindowInput& in, const Track& track, const PathGaussian& path,
                  const Eigen::Vector3d& theta, bool marginal);
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
