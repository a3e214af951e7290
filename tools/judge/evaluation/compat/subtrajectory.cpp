#include "tools/judge/evaluation/compat/subtrajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace evaluation::compat {

std::vector<IndexPair> PairsByLength(const std::vector<double>& way, double length_m, double tolerance_m) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double target = way[i] + length_m;
    const auto begin = way.begin() + static_cast<std::ptrdiff_t>(i);
    const auto after = std::lower_bound(begin, way.end(), target);
    double best = tolerance_m;
    std::size_t end = way.size();
    const auto offer = [&](std::vector<double>::const_iterator k) {
      if (!(std::abs(*k - target) < best)) return;
      best = std::abs(*k - target);
      end = static_cast<std::size_t>(k - way.begin());
    };
    if (after != begin) offer(std::lower_bound(begin, after, *(after - 1)));  // the first that far
    if (after != way.end()) offer(after);
    if (end < way.size()) pairs.emplace_back(i, end);
  }
  return pairs;
}

Eigen::Matrix3d BestYaw(const Eigen::Matrix3d& C) {
  const double theta = std::atan2(C(0, 1) - C(1, 0), C(0, 0) + C(1, 1));
  return Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Similarity AlignYaw(const MatchedTrajectories& matched) {
  const double n = static_cast<double>(matched.estimate.size());
  Eigen::Vector3d x_mean = Eigen::Vector3d::Zero(), y_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    x_mean += matched.estimate[i].p_WC / n;
    y_mean += matched.truth[i].p_WC / n;
  }
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    C += (matched.estimate[i].p_WC - x_mean) * (matched.truth[i].p_WC - y_mean).transpose();
  }
  Similarity result;
  result.R = BestYaw(C);
  result.t = y_mean - result.R * x_mean;
  return result;
}

}  // namespace evaluation::compat
