#include "vo/calibration/frame_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/base/median.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {

FrameMotion::FrameMotion(std::vector<double> times) : times_(std::move(times)) {}

int FrameMotion::First(int k) const { return std::clamp(k - kPoses / 2, 0, static_cast<int>(times_.size()) - kPoses); }

FrameMotion::Row FrameMotion::At(int k, double time) const {
  Row row{First(k), {}, {}};
  const double t = times_[k] + time;
  for (int j = 0; j < kPoses; ++j) {
    double value = 1, rate = 0, scale = 1;
    for (int i = 0; i < kPoses; ++i) {
      if (i == j) continue;
      const double off = t - times_[row.first + i];
      rate = rate * off + value;
      value *= off;
      scale *= times_[row.first + j] - times_[row.first + i];
    }
    row.weight[j] = value / scale;
    row.rate[j] = rate / scale;
  }
  return row;
}

Eigen::Matrix<double, 6, FrameMotion::kPoses> FrameMotion::Displacements(std::span<const Pose> poses, int first,
                                                                         int k) {
  Eigen::Matrix<double, 6, kPoses> out;
  for (int j = 0; j < kPoses; ++j) out.col(j) = Minus(poses[first + j], poses[k]);
  return out;
}

std::vector<double> RegularTimes(std::vector<double> times) {
  constexpr double kJitter = 0.3;  // of a period
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  if (steps.empty()) return times;
  const double usual = UpperMedian(steps);
  double periods = 0;
  for (double& step : steps) {
    const double count = std::round(step / usual);
    if (count < 1 || std::abs(step / usual - count) > kJitter) return times;
    periods += step = count;
  }
  const double period = (times.back() - times.front()) / periods;
  for (std::size_t k = 1; k < times.size(); ++k) times[k] = times[k - 1] + steps[k - 1] * period;
  return times;
}

}  // namespace vo
