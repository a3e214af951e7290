// Linearisation of a path window at one particle's path: what the normal equations are assembled from, and what the
// chord method keeps.
// Tangent: as in path_window.h; where the rates of rows are estimated, they follow each pose.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "vo/filter/path_gaussian.h"
#include "vo/map/landmark.h"

namespace vo {

// Image from the stamp's camera, by the rate of a row's frame: d / d(dw in C) of the point that the row sees.
Matrix23 RateJacobian(const RowView& row);

// Observations of one landmark in the window, the same for all particles. A landmark's first view is its prior, not an
// observation.
struct Track {
  struct View {
    int slot = 0;
    Eigen::Vector2d z = Eigen::Vector2d::Zero();
    Eigen::Matrix2d R_inverse = Eigen::Matrix2d::Identity();
    double log_det_R = 0;
    Eigen::Vector3d centre_offset_W = Eigen::Vector3d::Zero();  // as in Match
    double row_time = 0;                                        // after the stamp [s]

    Matrix23 ByRate() const { return RateJacobian({z, row_time}); }
  };
  int landmark = 0;
  int anchor = 0;        // index of the anchor pose
  int anchor_slot = -1;  // its slot, or -1: it has been sampled
  std::vector<View> views;
  Eigen::Matrix2d wander = Eigen::Matrix2d::Zero();  // per view; R contains it from the first view of the window on
  bool provisional = false;  // the landmark follows the poses and does not act on them; behind all others
};

// Sampled state of one particle, from which its window begins.
struct WindowInput {
  const Pose& start;        // the last sampled pose
  const Vector6& velocity;  // mean at the start
  std::span<const Landmark> landmarks;
  std::span<const Pose> anchors;                // those of the window are not read
  std::span<const FirstView> first_views = {};  // read where the rates of rows are estimated
};

// The anchor's pose on the particle's path, sampled or not.
inline const Pose& AnchorOn(const PathGaussian& path, const WindowInput& in, const Track& track) {
  return track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
}

// Rates of rows that are variables besides the poses: of no frame, of those of the window, and of the start's as well.
enum class Rates { none, of_window, with_start };

// Rows of a slot in the equations: (dp in W, dphi in C) and, where the rates of rows are estimated, (dw in C).
constexpr int kRateSlotSize = kPoseSize + 3;

// A window linearised at one particle's path, each landmark as a standard normal u with theta = mean + L u.
struct PathLinearisation {
  struct View {
    bool used = false;  // in front
    Matrix23 J_landmark, WM;
    Eigen::Matrix<double, kRateSlotSize, 2> JtW, AtW;
  };
  struct Eliminated {
    Eigen::Matrix3d L;
    Eigen::LLT<Eigen::Matrix3d> G;  // information of u given the poses
    Eigen::Matrix3d U_inverse;      // of its upper factor
    Matrix23 ray_by_rate;           // of the first view, by the rate of the anchor's rows
    bool used = false;
    Eigen::Index row, end;    // of its columns of Y: the other rows are 0
    Eigen::Index anchor_row;  // -1: the anchor has been sampled
  };
  Eigen::Index slot_size = kPoseSize;
  bool with_rates() const { return slot_size > kPoseSize; }
  // First row of a slot, and of its rate. With rates the start has a slot, -1, whose pose stays.
  Eigen::Index Row(int slot) const { return slot_size * (with_rates() ? slot + 1 : slot); }
  Eigen::Index RateRow(int slot) const { return Row(slot) + kPoseSize; }
  Eigen::MatrixXd J;                  // of the steps u: du_k / d(pose k-1), du_k / d(pose k), per step 6 x 12
  std::vector<View> views;            // in the order of the tracks
  std::vector<Eliminated> landmarks;  // per track
  Eigen::MatrixXd Y;                  // whitened couplings of poses and landmarks, 3 columns per track
  Eigen::Index acting = 0;            // columns of the tracks that act on the poses, the first

  // Rows that a track couples: from the first view or the anchor, where this is a variable, to the last view.
  void SetRows(Eliminated& landmark, const Track& track, Rates rates) const;
  // Sets J. Returns the log determinant of its volume change, squared.
  double LineariseSteps(const PathGaussian& path, const Pose& start);
  // Shift of a view's image point by the rate of its frame; 0 without rates.
  Eigen::Vector2d RateShift(const Track::View& view, const PathGaussian& path) const {
    if (!with_rates()) return Eigen::Vector2d::Zero();
    return view.ByRate() * path.rates[view.slot + 1];
  }
  // A landmark's mean by its first view, at the rate of the anchor's rows.
  Eigen::Vector3d MeanOf(std::size_t index, const WindowInput& in, const Track& track, const PathGaussian& path) const;
};

// The prior's share of b, and of the cost, which is returned.
double SetPriorGradient(const PathPrior& prior, const Pose& start, const Vector6& velocity, const PathGaussian& path,
                        const PathLinearisation& linear, Eigen::VectorXd& b);

// Poses and rates moved by a step of the equations.
void MoveBy(const Eigen::VectorXd& step, const PathLinearisation& linear, PathGaussian& path);

}  // namespace vo
