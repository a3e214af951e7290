// Guided matching: each predicted landmark is searched for at every pixel of a small window, by smallest Hamming
// distance; the window grows where nothing fits; the match is then registered to sub-pixel accuracy.
// Source:  docs/algorithm.md, section 7.
// Units:   pixels.
#pragma once

#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/brisk.h"
#include "vo/features/patch.h"

namespace vo {

// Appearance of a landmark in its first view.
struct Appearance {
  Descriptor descriptor{};
  Patch patch;
};

struct SearchRequest {
  const Appearance* appearance = nullptr;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();   // [px]
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();           // innovation covariance [px^2]
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();    // d(present pixel)/d(pixel of the first view)
  Eigen::Vector2d first_rate = Eigen::Vector2d::Zero();  // of the first view, and now, in the present image [px/s]
  Eigen::Vector2d rate = Eigen::Vector2d::Zero();
  std::optional<int> widest_px = std::nullopt;  // upper limit of the window's side; none: of the settings
};

// Side of the search window for an innovation covariance S [px^2]: 2 ceil(2.5 sigma) + 1, sigma^2 = max(S_xx, S_yy).
int WindowSide(const Eigen::Matrix2d& S);

// Sampler for first views: upright, at the scale of the settings.
BriskSampler FirstSampler(const FeatureParams& params);

struct FoundFeature {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d noise;  // covariance of the measurement [px^2], from this image alone
};

struct SearchResult {
  bool in_sight = true;  // the pattern at the predicted pixel lies inside the image
  std::optional<FoundFeature> found;
};

// One result per request, in the same order. `brisk` holds the image; `smooth`: the smoothed image, for registration.
// `exposure_s`: first views and the image are compared at equal blur; 0: as they are.
std::vector<SearchResult> FindFeatures(const std::vector<SearchRequest>& requests, const cv::Mat& smooth,
                                       const BriskImage& brisk, const FeatureParams& params, double exposure_s = 0);

}  // namespace vo
