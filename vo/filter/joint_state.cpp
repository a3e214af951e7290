#include "vo/filter/joint_state.h"

#include <Eigen/LU>

#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace vo {

JointState JointState::Displaced(const Eigen::VectorXd& d) const {
  JointState state = *this;
  state.pose = Plus(pose, d.head<6>());
  state.velocity = velocity + d.segment<6>(6);
  for (std::size_t a = 0; a < anchors.size(); ++a) state.anchors[a] = Plus(anchors[a], d.segment<6>(anchor_offset[a]));
  for (std::size_t n = 0; n < landmarks.size(); ++n)
    state.landmarks[n].mean = landmarks[n].mean + d.segment<3>(landmark_offset[n]);
  return state;
}

void JointState::Add(std::span<const Landmark> added, int size) {
  anchors.push_back(pose);
  anchor_offset.push_back(size);
  for (std::size_t i = 0; i < added.size(); ++i) {
    landmarks.push_back(added[i]);
    landmark_offset.push_back(size + 6 + 3 * static_cast<int>(i));
    anchor_of.push_back(static_cast<int>(anchors.size()) - 1);
  }
}

std::vector<int> JointState::Keep(const std::vector<bool>& keep) {
  std::vector<bool> used(anchors.size(), false);
  for (std::size_t n = 0; n < keep.size(); ++n)
    if (keep[n]) used[anchor_of[n]] = true;
  std::vector<int> entries;
  const auto take = [&](int offset, int size) {
    const int to = static_cast<int>(entries.size());
    for (int i = 0; i < size; ++i) entries.push_back(offset + i);
    return to;
  };
  take(0, kCameraSize);
  std::size_t to = 0, n = 0, kept = 0;
  for (std::size_t a = 0; a < anchors.size(); ++a) {
    const std::size_t slot = to;
    if (used[a]) {
      anchors[to] = anchors[a];
      anchor_offset[to++] = take(anchor_offset[a], 6);
    }
    for (; n < keep.size() && anchor_of[n] == static_cast<int>(a); ++n) {
      if (!keep[n]) continue;
      landmarks[kept] = landmarks[n];
      anchor_of[kept] = static_cast<int>(slot);
      landmark_offset[kept++] = take(landmark_offset[n], 3);
    }
  }
  anchors.resize(to);
  anchor_offset.resize(to);
  landmarks.resize(kept);
  landmark_offset.resize(kept);
  anchor_of.resize(kept);
  return entries;
}

JointMeasurement::JointMeasurement(std::span<const Match> matches, const JointState& state, const Eigen::VectorXd& d) {
  const std::vector<AnchorView> views = ViewsOf(state.anchors, state.pose);
  const Eigen::Matrix3d J_r = RightJacobian(d.segment<3>(3));
  std::vector<Eigen::Matrix3d> J_r_anchor;
  for (const int offset : state.anchor_offset) J_r_anchor.push_back(RightJacobian(d.segment<3>(offset + 3)));
  for (const Match& match : matches) {
    const int anchor = state.anchor_of[match.landmark];
    const Eigen::Vector3d& theta = state.landmarks[match.landmark].mean;
    const Projection h = Project(views[anchor].ShiftedBy(match.centre_offset_W), theta);
    if (!h.in_front) continue;
    Row row;
    row.anchor_offset = state.anchor_offset[anchor];
    row.landmark_offset = state.landmark_offset[match.landmark];
    row.residual = match.z - h.z;
    row.R = match.R;
    row.H_pose = h.J_pose;
    row.H_pose.rightCols<3>() *= J_r;
    row.H_anchor = AnchorJacobian(h, theta);
    row.H_anchor.rightCols<3>() *= J_r_anchor[anchor];
    row.H_landmark = h.J_landmark;
    cost_ += row.residual.dot(match.R.inverse() * row.residual);
    rows_.push_back(row);
  }
}

void JointMeasurement::AddTransposeTimes(const Eigen::VectorXd& y, Eigen::VectorXd& x) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    x.head<6>() += row.H_pose.transpose() * y.segment<2>(2 * i);
    x.segment<6>(row.anchor_offset) += row.H_anchor.transpose() * y.segment<2>(2 * i);
    x.segment<3>(row.landmark_offset) += row.H_landmark.transpose() * y.segment<2>(2 * i);
  }
}

void JointMeasurement::AddNoise(Eigen::MatrixXd& S) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) S.block<2, 2>(2 * i, 2 * i) += rows_[i].R;
}

void JointMeasurement::AddResidual(Eigen::VectorXd& innovation) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) innovation.segment<2>(2 * i) += rows_[i].residual;
}

}  // namespace vo
