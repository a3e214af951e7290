#include "vo/filter/adaptive_noise.h"

#include <algorithm>
#include <limits>

namespace vo {
namespace {

constexpr double kMargin = 1.4;  // on the densities
constexpr double kLeast = 1e-4;
constexpr double kRate = 0.1;      // of the mean, per frame; more in the first frames
constexpr double kMostOfOne = 20;  // that one frame counts for
constexpr double kLeastWidening = 4;
constexpr double kUnderstated = 2;  // innovation ratio of a frame that shows more noise than was assumed

double Ratio(const Eigen::Vector3d& change, const Eigen::Matrix3d& gained) {
  return change.squaredNorm() / std::max(gained.trace(), std::numeric_limits<double>::min());
}

double Gain(const Eigen::Matrix3d& gained, const Eigen::Matrix3d& predicted) {
  constexpr double kLeastGain = 0.2;
  return std::clamp(gained.trace() / std::max(predicted.trace(), std::numeric_limits<double>::min()), kLeastGain, 1.0);
}

// r - 1 = K (f / f_used - 1) on average.
void LearnOne(double ratio, double gain, double used, double rate, double& estimate) {
  const double shown = std::clamp(used * (1 + (ratio - 1) / gain) / estimate, -kMostOfOne, kMostOfOne);
  estimate = std::max(kLeast, estimate * (1 + rate * (shown - 1)));
}

}  // namespace

InnovationRatios RatiosOf(const PoseGaussian& predicted, const PoseGaussian& updated) {
  const Vector6 change = Minus(updated.mean, predicted.mean);
  const Matrix6 gained = predicted.covariance - updated.covariance;
  const Matrix6& P = predicted.covariance;
  return {Ratio(change.head<3>(), gained.topLeftCorner<3, 3>()),
          Ratio(change.tail<3>(), gained.bottomRightCorner<3, 3>()),
          Gain(gained.topLeftCorner<3, 3>(), P.topLeftCorner<3, 3>()),
          Gain(gained.bottomRightCorner<3, 3>(), P.bottomRightCorner<3, 3>())};
}

AdaptiveNoise::AdaptiveNoise() : position_(1 / kMargin), orientation_(1 / kMargin) {}

MotionInput AdaptiveNoise::Input() const { return {kMargin * position_, kMargin * orientation_}; }

void AdaptiveNoise::Learn(const InnovationRatios& ratios, const MotionInput& used) {
  const double rate = std::max(kRate, 1.0 / (2 + frames_++));
  LearnOne(ratios.position, ratios.position_gain, used.position_noise, rate, position_);
  LearnOne(ratios.orientation, ratios.orientation_gain, used.orientation_noise, rate, orientation_);
}

MotionInput Widened(const MotionInput& used, const InnovationRatios& ratios) {
  MotionInput wide = used;
  wide.position_noise = std::max(used.position_noise, 1.0) * std::clamp(ratios.position, kLeastWidening, kMostOfOne);
  wide.orientation_noise =
      std::max(used.orientation_noise, 1.0) * std::clamp(ratios.orientation, kLeastWidening, kMostOfOne);
  return wide;
}

std::optional<MotionInput> AsShown(const MotionInput& used, const InnovationRatios& ratios) {
  if (std::max(ratios.position, ratios.orientation) <= kUnderstated) return std::nullopt;
  MotionInput shown = used;
  if (ratios.position > kUnderstated) shown.position_noise *= ratios.position;
  if (ratios.orientation > kUnderstated) shown.orientation_noise *= ratios.orientation;
  return shown;
}

}  // namespace vo
