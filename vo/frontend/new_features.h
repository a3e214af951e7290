// Detection of the features at which landmarks begin: the corners of a calibration target, while one is expected, and
// corners spread over the image.
// Source:  docs/algorithm.md, section 7.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark.h"

namespace vo {

struct NewFeature {
  Eigen::Vector2i pixel;
  std::optional<KnownDepth> depth;  // on the target
};

class NewFeatureDetector {
 public:
  // Features are at least `border_px` from the edge of the image.
  NewFeatureDetector(const Camera& camera, const Params& params, int border_px);

  // Features away from `occupied`, those of the target first.
  std::vector<NewFeature> Detect(const PreparedFrame& frame, std::vector<Eigen::Vector2d> occupied);

 private:
  std::vector<NewFeature> DetectTarget(const PreparedFrame& frame);

  Camera camera_;
  FeatureParams features_;
  TargetParams target_;
  int border_px_;
  int target_frames_;  // left for the search for the target
};

// At most `capacity` features: those of the target, then others spread over the image.
std::vector<NewFeature> LimitToCapacity(std::vector<NewFeature> features, std::size_t capacity, const Camera& camera);

}  // namespace vo
