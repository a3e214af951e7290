#include "vo/frontend/corner_recognition.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"

namespace vo {
namespace {

constexpr float kMostHamming = 112;  // of 512 bits: the corner is found a pixel aside, and seen from elsewhere
constexpr float kRatio = 0.85F;      // of the nearest neighbour's distance to the second nearest's

cv::Mat Row(const Descriptor& descriptor) {
  return cv::Mat(1, sizeof(Descriptor), CV_8U, const_cast<std::uint64_t*>(descriptor.data()));
}

}  // namespace

std::vector<RecognisedCorner> RecogniseCorners(const PreparedFrame& frame, std::span<const Descriptor* const> known,
                                               FeatureParams params, int corners_factor, int border_px) {
  if (known.empty()) return {};
  params.per_cell *= corners_factor;
  const std::vector<Eigen::Vector2i> corners = DetectCorners(frame.grey, {}, border_px, params);
  if (corners.empty()) return {};
  const BriskSampler sampler = FirstSampler(params);
  cv::Mat of_corners, of_known;
  for (const Eigen::Vector2i& corner : corners) of_corners.push_back(Row(frame.brisk.Describe(corner, sampler)));
  for (const Descriptor* descriptor : known) of_known.push_back(Row(*descriptor));

  std::vector<std::vector<cv::DMatch>> neighbours;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(of_known, of_corners, neighbours, 2);
  std::vector<const cv::DMatch*> of_corner(corners.size(), nullptr);  // the nearest of the descriptors
  for (const std::vector<cv::DMatch>& nearest : neighbours) {
    if (nearest.size() < 2 || nearest[0].distance > std::min(kMostHamming, kRatio * nearest[1].distance)) continue;
    const cv::DMatch*& best = of_corner[static_cast<std::size_t>(nearest[0].trainIdx)];
    if (best == nullptr || nearest[0].distance < best->distance) best = nearest.data();
  }
  std::vector<RecognisedCorner> recognised;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (of_corner[i] != nullptr) recognised.push_back({static_cast<std::size_t>(of_corner[i]->queryIdx), corners[i]});
  return recognised;
}

}  // namespace vo
