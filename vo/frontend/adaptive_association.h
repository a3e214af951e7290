// Association of a frame whose prediction may fail: process noise estimated on line, the prediction repeated with more
// of it, then about the rotation that direct alignment of the images gives. A repetition is kept where clearly more
// matches agree; a frame in which too few agree has none.
// Source:  docs/algorithm.md, section 7.1.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "vo/filter/adaptive_noise.h"
#include "vo/frontend/association.h"

namespace vo {

class AdaptiveAssociation {
 public:
  explicit AdaptiveAssociation(const Camera& camera) : camera_(camera) {}

  // `associate` is called after each prediction, with its input. `coasting_s`: time from the first frame without
  // matches to the last frame; 0 where that had matches.
  Association PredictAndAssociate(Filter& filter, double dt, double coasting_s, const cv::Mat& grey,
                                  const std::function<Association(const MotionInput&)>& associate);

 private:
  // Whether the repetition is kept; otherwise the prediction of `input` is restored.
  bool Repeat(Filter& filter, const MotionInput& repeated,
              const std::function<Association(const MotionInput&)>& associate, MotionInput& input,
              Association& association) const;

  Camera camera_;
  AdaptiveNoise noise_;
  cv::Mat matched_;  // grey image of the last frame with matches
};

}  // namespace vo
