#include "tools/evaluation/rpe_tum.h"

#include <algorithm>
#include <cstdlib>

#include "tools/evaluation/so3.h"

namespace evaluation {
namespace {

// from^-1 to.
Eigen::Isometry3d Motion(const StampedPose& from, const StampedPose& to) {
  const auto matrix = [](const StampedPose& pose) {
    return Eigen::Translation3d(pose.p_WC) * Eigen::Isometry3d(pose.q_WC);
  };
  return matrix(from).inverse() * matrix(to);
}

Rpe Errors(const Trajectory& estimate, const Trajectory& truth, const std::vector<IndexPair>& candidates) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    intervals.push_back(static_cast<double>(truth[i].stamp_ns - truth[i - 1].stamp_ns));
  }
  const std::vector<std::int64_t> truth_ns = StampsOf(truth);
  const double allowed = 2 * Median(intervals);
  Rpe rpe;
  for (const auto& [i, j] : candidates) {
    const StampedPose& truth_i = truth[NearestIndex(truth_ns, estimate[i].stamp_ns)];
    const StampedPose& truth_j = truth[NearestIndex(truth_ns, estimate[j].stamp_ns)];
    if (static_cast<double>(std::abs(truth_i.stamp_ns - estimate[i].stamp_ns)) > allowed ||
        static_cast<double>(std::abs(truth_j.stamp_ns - estimate[j].stamp_ns)) > allowed) {
      continue;
    }
    const Eigen::Isometry3d E = Motion(estimate[i], estimate[j]) * Motion(truth_i, truth_j).inverse();  // A B^-1
    rpe.pairs.emplace_back(i, j);
    rpe.position.push_back(E.translation().norm());
    rpe.orientation.push_back(Log(Eigen::Quaterniond(E.linear())).norm());
  }
  rpe.position_statistics = Summarise(rpe.position);
  rpe.orientation_statistics = Summarise(rpe.orientation);
  return rpe;
}

}  // namespace

Rpe ComputeTumRpeByTime(const Trajectory& estimate, const Trajectory& truth, std::int64_t delta_ns) {
  if (estimate.size() < 2 || truth.size() < 2) return {};
  std::vector<IndexPair> candidates;
  const std::vector<std::int64_t> stamps_ns = StampsOf(estimate);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::size_t j = NearestIndex(stamps_ns, estimate[i].stamp_ns + delta_ns);
    if (j + 1 != estimate.size()) candidates.emplace_back(i, j);
  }
  return Errors(estimate, truth, candidates);
}

Rpe ComputeTumRpeByFrames(const Trajectory& estimate, const Trajectory& truth, std::size_t delta) {
  if (estimate.size() < 2 || truth.size() < 2) return {};
  std::vector<IndexPair> candidates;
  for (std::size_t i = 0; i + delta + 1 < estimate.size(); ++i) candidates.emplace_back(i, i + delta);
  return Errors(estimate, truth, candidates);
}

}  // namespace evaluation
