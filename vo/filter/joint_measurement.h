// Measurement of EKF-SLAM: all matches of a frame linearised at one state, H = dz / d(state) with three non-zero blocks
// for each match.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vo/filter/joint_state.h"

namespace vo {

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
