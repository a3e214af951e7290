// Exposure time from motion blur: of several candidates, the one whose blur makes the patches of first views most
// similar to the image. It is used to compare patches at equal blur (patch.h); zero until the images determine one.
// Source:  docs/algorithm.md, section 7.4. Mean over matches of log(1 - correlation), relative to that of no blur.
// Units:   seconds; pixels per second.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "vo/map/landmark_record.h"

namespace vo {

// Match that moves over the image.
struct MovingMatch {
  int landmark = 0;
  Eigen::Matrix2d warp;              // d(present pixel)/d(pixel of the first view)
  Eigen::Vector2d pixel;             // at the middle of the exposure
  Eigen::Vector2d first_rate, rate;  // in the first view and now, both in the present image [px/s]
};

class ExposureEstimate {
 public:
  double seconds() const { return seconds_; }
  // `records`: of the landmarks. `smooth`: the smoothed image.
  void Learn(std::span<const MovingMatch> matches, std::span<const LandmarkRecord> records, const cv::Mat& smooth);

 private:
  static constexpr int kCandidates = 9;
  std::array<double, kCandidates> sum_{}, squares_{};  // of the gains over no blur
  double weight_ = 0;
  double seconds_ = 0;
};

}  // namespace vo
