// Joint state of EKF-SLAM: camera pose and velocity, anchor poses, and landmarks, with their places in the state
// vector.
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

}  // namespace vo
