// Scale from a calibration target: a chessboard of known size at the start gives the inverse depths of its inner
// corners to a fraction of a per cent.
// Source:  OpenCV's findChessboardCornersSB (Duda & Frese 2018, "Accurate detection and localization of checkerboard
//          corners for calibration") and solvePnP.
// Units:   metres, pixels.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vo/base/params.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark.h"

namespace vo {

struct TargetCorner {
  Eigen::Vector2i pixel;  // nearest whole pixel; the depth is that of the board's plane there
  KnownDepth depth;
};

// Inner corners of the board, row by row; empty unless all are visible at invertible pixels. Corners are measured with
// `sigma_px`. The distance of the board is an error common to all corners, but a filter takes them for independent:
// sigma^2 is n times the variance from the board's pose, so that the mean of n corners has the right one.
std::vector<TargetCorner> FindTarget(const cv::Mat& grey, const Camera& camera, const TargetParams& target,
                                     double sigma_px);

}  // namespace vo
