#include "vo/filter/adaptive_noise.h"

#include <algorithm>
#include <limits>

namespace vo {
namespace {

constexpr double kMargin = 4;  // on the densities: 2 in standard deviation
constexpr double kLeast = 1 / kMargin;
constexpr double kRate = 0.1;      // of the mean, per frame
constexpr double kMostOfOne = 20;  // that one frame counts for
constexpr double kLeastWidening = 4;

double Ratio(const Eigen::Vector3d& change, const Eigen::Matrix3d& gained) {
  return change.squaredNorm() / std::max(gained.trace(), std::numeric_limits<double>::min());
}

void LearnOne(double ratio, double used, double& estimate) {
  const double shown = std::min(used * ratio / estimate, kMostOfOne);
  estimate = std::max(kLeast, estimate * (1 + kRate * (shown - 1)));
}

}  // namespace

InnovationRatios RatiosOf(const PoseGaussian& predicted, const PoseGaussian& updated) {
  const Vector6 change = Minus(updated.mean, predicted.mean);
  const Matrix6 gained = predicted.covariance - updated.covariance;
  return {Ratio(change.head<3>(), gained.topLeftCorner<3, 3>()),
          Ratio(change.tail<3>(), gained.bottomRightCorner<3, 3>())};
}

AdaptiveNoise::AdaptiveNoise() : position_(kLeast), orientation_(kLeast) {}

MotionInput AdaptiveNoise::Input() const { return {kMargin * position_, kMargin * orientation_}; }

void AdaptiveNoise::Learn(const InnovationRatios& ratios, const MotionInput& used) {
  LearnOne(ratios.position, used.position_noise, position_);
  LearnOne(ratios.orientation, used.orientation_noise, orientation_);
}

MotionInput Widened(const MotionInput& used, const InnovationRatios& ratios) {
  MotionInput wide = used;
  wide.position_noise *= std::clamp(ratios.position, kLeastWidening, kMostOfOne);
  wide.orientation_noise *= std::clamp(ratios.orientation, kLeastWidening, kMostOfOne);
  return wide;
}

}  // namespace vo
