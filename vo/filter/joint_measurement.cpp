#include "vo/filter/joint_measurement.h"

#include <Eigen/LU>

#include "vo/geometry/so3.h"

namespace vo {

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
