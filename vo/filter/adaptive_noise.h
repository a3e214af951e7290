// Process noise estimated on line: density of acceleration and angular acceleration in the camera, 6 x 6, relative to
// the power spectral densities of MotionParams. Hand-held motion has correlated and unequal axes.
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
  // Input of a prediction, from the camera's orientation at the last pose.
  MotionInput Input(const Eigen::Quaterniond& q_WC) const;
  // Mean over the frames, slow after the first ones: S + T (d d' - (P_predicted - P)) T' with d = x - x_predicted,
  // where T P_predicted T' = S is the density of `used`, the input of the prediction. `failed`: the first prediction
  // had failed, and the traces of S_k alone count.
  void Learn(const PoseGaussian& predicted, const PoseGaussian& updated, const MotionInput& used, bool failed);

 private:
  Matrix6 density_;  // of (p, delta), both in C
  int frames_ = 0;
};

// The input of a failed prediction with its noise, at least that of MotionParams, multiplied by the frame's ratios.
MotionInput Widened(const MotionInput& used, const InnovationRatios& ratios);
// The input with its noise multiplied by the frame's ratios, where these are significantly large; none elsewhere.
std::optional<MotionInput> Inflated(const MotionInput& used, const InnovationRatios& ratios);

}  // namespace vo
