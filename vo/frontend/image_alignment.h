// Rotation between two images by direct alignment: least squares of the photometric error over SO(3), coarse to fine.
// For small translations: parallax is taken for rotation.
// Source:  Szeliski, "Image alignment and stitching: a tutorial", 2006, section 4 (rotational motion); Baker and
//          Matthews, "Lucas-Kanade 20 years on", 2004 (inverse compositional).
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vo/geometry/camera.h"

namespace vo {

// Small smoothed copies of an image (CV_8UC1), coarse to fine: about 40, 80 and 160 px wide, CV_32FC1.
std::vector<cv::Mat> Thumbnails(const cv::Mat& grey);

// R with m_now ~ R m_then for the rays of distant points, from the best of a grid of turns. None where
// less than a quarter of the earlier image is in both, where the images do not determine it, or where it leaves most of
// their difference.
std::optional<Eigen::Quaterniond> AlignRotation(const Camera& camera, const std::vector<cv::Mat>& then,
                                                const std::vector<cv::Mat>& now);

}  // namespace vo
