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

void LearnOne(double ratio, double used, double rate, double& estimate) {
  const double shown = std::min(used * ratio / estimate, kMostOfOne);
  estimate = std::max(kLeast, estimate * (1 + rate * (shown - 1)));
}

}  // namespace

InnovationRatios RatiosOf(const PoseGaussian& predicted, const PoseGaussian& updated) {
  const Vector6 change = Minus(updated.mean, predicted.mean);
  const Matrix6 gained = predicted.covariance - updated.covariance;
  return {Ratio(change.head<3>(), gained.topLeftCorner<3, 3>()),
          Ratio(change.tail<3>(), gained.bottomRightCorner<3, 3>())};
}

AdaptiveNoise::AdaptiveNoise() : position_(1 / kMargin), orientation_(1 / kMargin) {}

MotionInput AdaptiveNoise::Input() const { return {kMargin * position_, kMargin * orientation_}; }

void AdaptiveNoise::Learn(const InnovationRatios& ratios, const MotionInput& used) {
  const double rate = std::max(kRate, 1.0 / (2 + frames_++));
  LearnOne(ratios.position, used.position_noise, rate, position_);
  LearnOne(ratios.orientation, used.orientation_noise, rate, orientation_);
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
