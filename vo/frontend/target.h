// Purpose: a chessboard of known size, seen at the start, tells the scale: the depths of its inner corners are known to a fraction of a
//          per cent, and so are, through motion and parallax, those of everything else.
// Source:  OpenCV's findChessboardCornersSB (Duda & Frese 2018, "Accurate detection and localization of checkerboard corners for
//          calibration") and solvePnP.
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
  Eigen::Vector2i pixel;  // whole, beside the corner: what is known is the board's plane there
  KnownDepth depth;
};

// The inner corners of the board, row by row; empty where it is not all in sight, or the lens has no ray. Corners count as seen to within `sigma_px`. The board's
// distance is one error that all corners share, but a filter takes theirs for independent: each is as uncertain as makes their mean right.
std::vector<TargetCorner> FindTarget(const cv::Mat& grey, const Camera& camera, const TargetParams& target,
                                     double sigma_px);

}  // namespace vo
