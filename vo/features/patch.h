// Sub-pixel registration of the patch of a landmark's first view to the present image.
// Source:  inverse-compositional Lucas-Kanade (Baker & Matthews, 2004), translation only, with gain and offset of
//          brightness removed; the patch is first warped by the predicted change of view. An addition to the paper.
// Units:   pixels, grey levels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

namespace vo {

// CV_8UC1 image after a 3 x 3 Gaussian (sigma 0.7 px): patches are cut from it and registered to it. It reduces noise
// and the aliasing of edges, which is fixed to the pixel grid.
cv::Mat Smooth(const cv::Mat& grey);

// Window about a corner in its first view, row by row; as wide as BRISK's pattern.
struct Patch {
  static constexpr int kRadius = 19;
  static constexpr int kSide = 2 * kRadius + 1;
  std::array<std::uint8_t, std::size_t{kSide} * kSide> grey{};
};

// `centre`: at least kRadius from the edge of the image.
Patch CutPatch(const cv::Mat& smooth, const Eigen::Vector2i& centre);

struct Registration {
  Eigen::Vector2d pixel;
  double correlation = 0;  // normalised cross-correlation
  // Least squares [px^2], from the gradients above the level of noise and aliasing; along an edge limited by the window
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

// Least determinant of a warp that is inverted.
constexpr double kLeastWarp = 0.1;

// `warp` = d(present pixel)/d(pixel of the first view). Along a straight edge (aperture problem) `start` is kept. None
// when the window leaves the image or the patch, the patch has no texture, the iteration does not converge or moves
// beyond `max_shift_px`. `streak`: along which the image is blurred first [px].
std::optional<Registration> Register(const Patch& patch, const Eigen::Matrix2d& warp, const cv::Mat& smooth,
                                     const Eigen::Vector2d& start, double max_shift_px,
                                     const Eigen::Vector2d& streak = Eigen::Vector2d::Zero());

}  // namespace vo
