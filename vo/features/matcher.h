// Purpose: finds each predicted landmark in the image: smallest Hamming distance over every pixel of a small window, the window
//          enlarged where nothing fits; then refined below the pixel.
// Source:  algorithm, section 7.
#pragma once

#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/brisk.h"
#include "vo/features/patch.h"

namespace vo {

// How a landmark looked when it was first seen.
struct Appearance {
  Descriptor descriptor{};
  Patch patch;
};

struct SearchRequest {
  const Appearance* appearance = nullptr;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();  // [px]
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();          // its covariance, pixel noise included [px^2]
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();   // d(present pixel)/d(pixel of the first view)
  std::optional<int> widest_px = std::nullopt;          // no window is wider than this; none: as the settings have it
};

// Side of the window that covers a prediction of this covariance [px^2], or any image where it is larger than that.
int WindowOf(const Eigen::Matrix2d& S);

// How a corner is described when it is first seen: as it lies.
BriskSampler FirstSampler(const FeatureParams& params);

struct FoundFeature {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d noise;  // covariance of its error [px^2], as this image alone tells it
};

struct SearchResult {
  bool in_sight =
      true;  // false: where it is predicted, its pattern reaches out of the image, and it was not looked for
  std::optional<FoundFeature> found;
};

// Of each request, in its order. `brisk` holds the image, `smooth` is it smoothed.
std::vector<SearchResult> FindFeatures(const std::vector<SearchRequest>& requests, const cv::Mat& smooth,
                                       const BriskImage& brisk, const FeatureParams& params);

}  // namespace vo
