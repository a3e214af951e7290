#include "vo/frontend/new_features.h"

#include <algorithm>
#include <cmath>

#include "vo/features/corner_detector.h"
#include "vo/frontend/target.h"

namespace vo {

NewFeatureDetector::NewFeatureDetector(const Camera& camera, const Params& params, int border_px)
    : camera_(camera),
      features_(params.features),
      target_(params.target),
      border_px_(border_px),
      target_frames_(target_.columns > 0 ? target_.frames : 0) {}

std::vector<NewFeature> NewFeatureDetector::Detect(const PreparedFrame& frame, std::vector<Eigen::Vector2d> occupied) {
  std::vector<NewFeature> found = DetectTarget(frame);
  for (const NewFeature& feature : found) occupied.push_back(feature.pixel.cast<double>());
  for (const Eigen::Vector2i& corner : DetectCorners(frame.grey, occupied, border_px_, features_))
    if (camera_.IsUsable(corner.cast<double>())) found.push_back({corner, std::nullopt});
  return found;
}

std::vector<NewFeature> NewFeatureDetector::DetectTarget(const PreparedFrame& frame) {
  std::vector<NewFeature> found;
  if (target_frames_ == 0) return found;
  --target_frames_;
  const std::vector<TargetCorner> corners = FindTarget(frame.grey, camera_, target_, features_.sigma_floor_px);
  if (corners.empty()) return found;
  target_frames_ = 0;
  for (const TargetCorner& corner : corners)
    if (camera_.IsUsable(corner.pixel.cast<double>(), border_px_)) found.push_back({corner.pixel, corner.depth});
  return found;
}

std::vector<NewFeature> LimitToCapacity(std::vector<NewFeature> features, std::size_t capacity, const Camera& camera) {
  if (features.size() <= capacity) return features;
  std::vector<Eigen::Vector2d> pixels;
  for (const NewFeature& feature : features) pixels.push_back(feature.pixel.cast<double>());
  const int cells = std::max(1, static_cast<int>(std::sqrt(capacity)));
  std::vector<std::size_t> order = BucketRoundRobin(pixels, cells, cells, camera.width, camera.height);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return features[i].depth.has_value(); });
  std::vector<NewFeature> chosen;
  for (std::size_t i = 0; i < capacity; ++i) chosen.push_back(features[order[i]]);
  return chosen;
}

}  // namespace vo
