#include "tools/judge/evaluation/compat/tum.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/compat/python_random.h"
#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation::compat {
namespace {

// from^-1 to.
Eigen::Isometry3d Motion(const StampedPose& from, const StampedPose& to) {
  const auto matrix = [](const StampedPose& pose) {
    return Eigen::Translation3d(pose.p_WC) * Eigen::Isometry3d(pose.q_WC);
  };
  return matrix(from).inverse() * matrix(to);
}

Rpe Errors(const Trajectory& estimate, const Trajectory& truth, const std::vector<IndexPair>& candidates,
           const TumRpeOptions& options) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    intervals.push_back(static_cast<double>(truth[i].stamp_ns - truth[i - 1].stamp_ns));
  }
  const std::vector<std::int64_t> truth_ns = StampsOf(truth);
  const double allowed = 2 * Median(intervals);
  Rpe rpe;
  rpe.scale = options.scale;
  for (const auto& [i, j] : candidates) {
    const std::int64_t time_i = estimate[i].stamp_ns + options.offset_ns,
                       time_j = estimate[j].stamp_ns + options.offset_ns;
    const StampedPose& truth_i = truth[NearestIndex(truth_ns, time_i)];
    const StampedPose& truth_j = truth[NearestIndex(truth_ns, time_j)];
    if (static_cast<double>(std::abs(truth_i.stamp_ns - time_i)) > allowed ||
        static_cast<double>(std::abs(truth_j.stamp_ns - time_j)) > allowed) {
      continue;
    }
    Eigen::Isometry3d A = Motion(estimate[i], estimate[j]);
    A.translation() *= options.scale;
    const Eigen::Isometry3d E = A * Motion(truth_i, truth_j).inverse();  // A B^-1
    rpe.pairs.emplace_back(i, j);
    rpe.position.push_back(E.translation().norm());
    rpe.orientation.push_back(Log(Eigen::Quaterniond(E.linear())).norm());
  }
  rpe.position_statistics = Summarise(rpe.position);
  rpe.orientation_statistics = Summarise(rpe.orientation);
  return rpe;
}

// Where each pose is on the axis that delta is measured on, but for seconds: frames, or the way or the turn so far.
std::vector<double> Axis(const Trajectory& estimate, const TumRpeOptions& options) {
  std::vector<double> axis{0};
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    double step = 1;
    if (options.unit == TumDeltaUnit::metres) step = (estimate[i].p_WC - estimate[i - 1].p_WC).norm();
    if (options.unit == TumDeltaUnit::radians) step = AngleBetween(estimate[i - 1].q_WC, estimate[i].q_WC);
    if (options.unit == TumDeltaUnit::degrees) step = AngleBetween(estimate[i - 1].q_WC, estimate[i].q_WC) * 180 / M_PI;
    axis.push_back(axis.back() + step);
  }
  return axis;
}

// Index of the value nearest to x, the earlier of two equally near.
std::size_t Nearest(const std::vector<double>& ascending, double x) {
  const auto after = std::lower_bound(ascending.begin(), ascending.end(), x);
  if (after == ascending.begin()) return 0;
  const auto index = static_cast<std::size_t>(after - ascending.begin());
  if (after == ascending.end() || x - ascending[index - 1] <= ascending[index] - x) return index - 1;
  return index;
}

std::vector<IndexPair> FixedPairs(const Trajectory& estimate, const TumRpeOptions& options) {
  std::vector<IndexPair> pairs;
  const bool by_time = options.unit == TumDeltaUnit::seconds;
  const std::vector<std::int64_t> stamps_ns = StampsOf(estimate);
  const std::vector<double> axis = by_time ? std::vector<double>{} : Axis(estimate, options);
  const auto delta_ns = by_time ? static_cast<std::int64_t>(std::llround(options.delta * 1e9)) : 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::size_t j =
        by_time ? NearestIndex(stamps_ns, stamps_ns[i] + delta_ns) : Nearest(axis, axis[i] + options.delta);
    if (j + 1 != estimate.size()) pairs.emplace_back(i, j);
  }
  if (options.max_pairs == 0 || pairs.size() <= options.max_pairs) return pairs;
  PythonRandom random(options.seed);
  std::vector<IndexPair> drawn;
  for (const std::size_t k : random.Sample(pairs.size(), options.max_pairs)) drawn.push_back(pairs[k]);
  return drawn;
}

// Every ordered pair, a pose with itself included; or as many drawn, with replacement.
std::vector<IndexPair> AnyPairs(std::size_t n, const TumRpeOptions& options) {
  std::vector<IndexPair> pairs;
  if (options.max_pairs == 0 || static_cast<double>(n) < std::sqrt(static_cast<double>(options.max_pairs))) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) pairs.emplace_back(i, j);
    }
    return pairs;
  }
  PythonRandom random(options.seed);
  while (pairs.size() < options.max_pairs) {
    const std::size_t i = random.Below(n);
    pairs.emplace_back(i, random.Below(n));
  }
  return pairs;
}

std::string Lines(const std::string& what, const Statistics& s, double factor, const std::string& unit) {
  std::string text;
  for (const auto& [part, value] : Parts(s))
    text += what + "." + part + " " + Fixed(factor * value, 6) + " " + unit + "\n";
  return text;
}

std::string Compared(std::size_t pairs) { return "compared_pose_pairs " + std::to_string(pairs) + " pairs\n"; }

}  // namespace

Ate ComputeTumAte(const Trajectory& estimate, const Trajectory& truth, const TumAteOptions& options) {
  const Trajectory moved = Shifted(estimate, options.offset_ns, options.scale);
  const AssociationOptions association{AssociationRule::tum, options.max_difference_ns};
  const MatchedTrajectories matched = MatchTrajectories(moved, truth, association);
  if (matched.estimate.size() < 2) throw InputError({"TUM's ATE: couldn't find two matching pairs of stamps"});
  return ComputeAte(matched, Alignment::se3);
}

Rpe ComputeTumRpe(const Trajectory& estimate, const Trajectory& truth, const TumRpeOptions& options) {
  Rpe rpe;
  if (estimate.size() >= 2 && truth.size() >= 2) {
    const auto candidates = options.fixed_delta ? FixedPairs(estimate, options) : AnyPairs(estimate.size(), options);
    rpe = Errors(estimate, truth, candidates, options);
  }
  if (rpe.pairs.empty()) {
    throw InputError(
        {"TUM's RPE: no pair of poses is left; do estimate and truth overlap in time, and is the estimate "
         "longer than delta?"});
  }
  return rpe;
}

std::string Print(const Ate& ate, const TumAteOptions& options) {
  if (!options.verbose) return Fixed(ate.position.rmse, 6) + "\n";
  return Compared(ate.position.count) + Lines("absolute_translational_error", ate.position, 1, "m");
}

std::string Print(const Rpe& rpe, const TumRpeOptions& options) {
  // Without --verbose the script prints as many digits as a double has; twelve are the same on every machine.
  if (!options.verbose) return Significant(rpe.position_statistics.mean, 12) + "\n";
  return Compared(rpe.pairs.size()) + Lines("translational_error", rpe.position_statistics, 1, "m") +
         Lines("rotational_error", rpe.orientation_statistics, kDegrees, "deg");
}

}  // namespace evaluation::compat
