// Purpose: where exactly, to a fraction of a pixel, the patch of a landmark's first view lies in the present image.
// Source:  inverse-compositional Lucas-Kanade (Baker & Matthews, 2004), translation only, gain and offset of brightness removed;
//          the patch is first warped by the predicted change of view. Our addition to the paper: see docs/odometry.md.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace vo {

// The surroundings of a corner in its first view, in grey levels, row by row.
struct Patch {
  static constexpr int kRadius = 10;
  static constexpr int kSide = 2 * kRadius + 1;
  std::array<std::uint8_t, kSide * kSide> grey{};
};

// `centre` at least kRadius from the edge of the CV_8UC1 image.
Patch CutPatch(const cv::Mat& grey, const Eigen::Vector2i& centre);

// Ratio of the smaller to the larger eigenvalue of the gradients' second moments about the centre, 0 ... 1: near 0 on a straight edge,
// along which a match slides.
double Cornerness(const Patch& patch);

struct Registration {
  Eigen::Vector2d pixel;
  double correlation = 0;  // normalised, -1 ... 1
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of least squares: residual variance times H^-1 [px^2]; wide along edges and blur
};

// `warp` = d(present pixel)/d(pixel of the first view). None when the window leaves the image, the patch has no corner, the
// search does not settle or wanders more than `max_shift_px` from `start`.
std::optional<Registration> Register(const Patch& patch, const Eigen::Matrix2d& warp, const cv::Mat& grey,
                                     const Eigen::Vector2d& start, double max_shift_px);

}  // namespace vo
