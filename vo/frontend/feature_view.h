// Features of one frame as the association saw them.
#pragma once

#include <Eigen/Core>

namespace vo {

// A feature as seen in the last frame, for drawing and for measuring.
struct FeatureView {
  enum class Status { matched, missed, rejected, fresh };
  int id = 0;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();  // [px]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();      // [px], of the match (or the prediction when missed)
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();          // innovation covariance [px^2]
  // Of the match's error, as the filter takes it [px^2]; zero where nothing was found
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  Status status = Status::missed;
};

}  // namespace vo
