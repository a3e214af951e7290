// Purpose: where exactly, to a fraction of a pixel, the patch of a landmark's first view lies in the present image.
// Source:  inverse-compositional Lucas-Kanade (Baker & Matthews, 2004), translation only, gain and offset of brightness removed;
//          the patch is first warped by the predicted change of view. Our addition to the paper: see docs/odometry.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

namespace vo {

// What patches are cut from and registered to: the CV_8UC1 image smoothed by 3 x 3 (sigma 0.7 px), so that noise and the staircase that the grid
// of pixels makes of an edge, which stays where the grid is, weigh less.
cv::Mat Smooth(const cv::Mat& grey);

// The surroundings of a corner in its first view, in grey levels, row by row.
struct Patch {
  static constexpr int kRadius = 10;
  static constexpr int kSide = 2 * kRadius + 1;
  std::array<std::uint8_t, std::size_t{kSide} * kSide> grey{};
};

// `centre` at least kRadius from the edge of the smooth image.
Patch CutPatch(const cv::Mat& smooth, const Eigen::Vector2i& centre);

struct Registration {
  Eigen::Vector2d pixel;
  double correlation = 0;  // normalised, -1 ... 1
  // Of least squares [px^2], as if noise and staircase told nothing; along an edge as wide as the window
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

// `warp` = d(present pixel)/d(pixel of the first view). Along a straight edge the pixel is left where `start` is. None when the window leaves the
// image, the patch is blank, the search does not settle or wanders more than `max_shift_px` from `start`.
std::optional<Registration> Register(const Patch& patch, const Eigen::Matrix2d& warp, const cv::Mat& smooth,
                                     const Eigen::Vector2d& start, double max_shift_px);

}  // namespace vo
