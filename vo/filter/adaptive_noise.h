// Process noise estimated on line: factors on the power spectral densities of position and orientation.
// Source:  innovation-based estimation (Mehra, "On the identification of variances and adaptive Kalman filtering", IEEE
//          Trans. Automatic Control 15, 1970), with r = |x - x_predicted|^2 / tr(P_predicted - P), which is 1 on
//          average where the model's noise is right; docs/algorithm.md, section 2.1.
#pragma once

#include "vo/filter/motion_model.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {

// r of position and of orientation.
struct InnovationRatios {
  double position = 0, orientation = 0;
};
InnovationRatios RatiosOf(const PoseGaussian& predicted, const PoseGaussian& updated);

class AdaptiveNoise {
 public:
  AdaptiveNoise();
  // What a prediction takes: the estimates times a margin.
  MotionInput Input() const;
  // Mean of what the frames show, slow after the first ones; `used`: the input of the prediction.
  void Learn(const InnovationRatios& ratios, const MotionInput& used);

 private:
  double position_, orientation_;
  int frames_ = 0;
};

// The input of a failed prediction with its noise, at least that of MotionParams, multiplied by what the frame shows.
MotionInput Widened(const MotionInput& used, const InnovationRatios& ratios);
// The input of a prediction whose noise the frame shows to be too small, multiplied by what it shows; none elsewhere.
std::optional<MotionInput> AsShown(const MotionInput& used, const InnovationRatios& ratios);

}  // namespace vo
