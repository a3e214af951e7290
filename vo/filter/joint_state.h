// Joint state of EKF-SLAM: camera pose and velocity, anchor poses, and landmarks, with their places in the state
// vector; and the measurement of a frame, its matches linearised at one state.
// Order:   camera (12), then each anchor (6) followed by its landmarks (3 each).
// Tangent: pose and anchors (dp in W, dphi in C), velocity (dv in W, dw in C); right perturbation.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vo/map/landmark.h"
#include "vo/map/local_map.h"

namespace vo {

constexpr int kCameraSize = 12;  // pose and velocity

struct JointState {
  Pose pose;
  Vector6 velocity;  // (v in W, w in C)
  std::vector<Pose> anchors;
  std::vector<Landmark> landmarks;                  // with their marginal covariance
  std::vector<int> anchor_of;                       // per landmark
  std::vector<int> anchor_offset, landmark_offset;  // in the state vector

  LocalMap map() const { return {landmarks, anchor_of, anchors}; }
  int AnchorOffsetOf(int landmark) const { return anchor_offset[anchor_of[landmark]]; }
  // The means moved by d.
  JointState Displaced(const Eigen::VectorXd& d) const;
  // New landmarks behind the others, at offsets from `size` on; their anchor is the present pose.
  void Add(std::span<const Landmark> added, int size);
  // Keeps the landmarks marked true, and the anchors that they use. Returns the entries of the state vector that stay.
  std::vector<int> Keep(const std::vector<bool>& keep);
};

// H = dz / d(state) with three non-zero blocks for each match.
class JointMeasurement {
 public:
  // At `state` = prior (+) d, as derivatives by d. Matches of landmarks behind the camera are left out.
  JointMeasurement(std::span<const Match> matches, const JointState& state, const Eigen::VectorXd& d);

  std::size_t size() const { return rows_.size(); }
  double cost() const { return cost_; }  // sum of r' R^-1 r
  template <class Matrix>
  Eigen::MatrixXd Times(const Matrix& M) const;                                // H M
  void AddTransposeTimes(const Eigen::VectorXd& y, Eigen::VectorXd& x) const;  // x += H' y
  void AddNoise(Eigen::MatrixXd& S) const;                                     // S += R
  void AddResidual(Eigen::VectorXd& innovation) const;

 private:
  struct Row {
    Eigen::Vector2d residual;
    Eigen::Matrix2d R;
    Matrix26 H_pose, H_anchor;
    Matrix23 H_landmark;
    int anchor_offset = 0, landmark_offset = 0;
  };
  std::vector<Row> rows_;
  double cost_ = 0;
};

template <class Matrix>
Eigen::MatrixXd JointMeasurement::Times(const Matrix& M) const {
  Eigen::MatrixXd result(2 * rows_.size(), M.cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    result.middleRows<2>(2 * i).noalias() = row.H_pose * M.template topRows<6>() +
                                            row.H_anchor * M.template middleRows<6>(row.anchor_offset) +
                                            row.H_landmark * M.template middleRows<3>(row.landmark_offset);
  }
  return result;
}

}  // namespace vo
