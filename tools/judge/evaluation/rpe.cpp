#include "tools/judge/evaluation/rpe.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "tools/judge/evaluation/so3.h"

namespace evaluation {
namespace {

struct Motion {
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
};

// from^-1 to, translation times scale.
Motion Between(const StampedPose& from, const StampedPose& to, double scale) {
  const Eigen::Quaterniond inverse = from.q_WC.conjugate();
  return {inverse * to.q_WC, scale * (inverse * (to.p_WC - from.p_WC))};
}

}  // namespace

Rpe ComputeRpe(const MatchedTrajectories& matched, std::vector<IndexPair> pairs, double scale) {
  Rpe rpe;
  rpe.pairs = std::move(pairs);
  rpe.scale = scale;
  for (const auto& [i, j] : rpe.pairs) {
    if (std::max(i, j) >= std::min(matched.estimate.size(), matched.truth.size()))
      throw std::logic_error("ComputeRpe: a pair beyond the trajectories");
    const Motion A = Between(matched.estimate[i], matched.estimate[j], scale);
    const Motion B = Between(matched.truth[i], matched.truth[j], 1);
    rpe.position.push_back((A.t - B.t).norm());  // translation of B^-1 A, but for B's rotation
    rpe.orientation.push_back(AngleBetween(B.q, A.q));
  }
  rpe.position_statistics = Summarise(rpe.position);
  rpe.orientation_statistics = Summarise(rpe.orientation);
  return rpe;
}

std::vector<IndexPair> PairsByTime(const Trajectory& truth, std::int64_t delta_ns, std::int64_t tolerance_ns) {
  std::vector<IndexPair> pairs;
  std::size_t j = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::int64_t target = truth[i].stamp_ns + delta_ns;
    const auto miss = [&](std::size_t k) { return std::abs(truth.at(k).stamp_ns - target); };
    j = std::max(j, i + 1);
    while (j + 1 < truth.size() && miss(j + 1) < miss(j)) ++j;
    if (j < truth.size() && miss(j) <= tolerance_ns) pairs.emplace_back(i, j);
  }
  return pairs;
}

std::vector<IndexPair> PairsByFrames(std::size_t poses, std::size_t delta, PairSelection selection) {
  if (delta == 0) throw std::invalid_argument("PairsByFrames: delta must be at least one frame");
  std::vector<IndexPair> pairs;
  const std::size_t step = selection == PairSelection::all ? 1 : delta;
  for (std::size_t i = 0; i + delta < poses; i += step) pairs.emplace_back(i, i + delta);
  return pairs;
}

std::vector<IndexPair> PairsByPath(const Trajectory& trajectory, double delta_m, PairSelection selection,
                                   double tolerance) {
  if (!(delta_m > 0)) throw std::invalid_argument("PairsByPath: delta must be more than zero metres");
  const std::vector<double> way = CumulativePathLength(trajectory);
  std::vector<IndexPair> pairs;
  if (selection == PairSelection::all) {
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const auto miss = [&](std::size_t k) { return std::abs(way.at(k) - way[i] - delta_m); };
      std::size_t best = i + 1;
      for (std::size_t k = i + 2; k < way.size() && way[k - 1] - way[i] < delta_m; ++k) {
        if (miss(k) < miss(best)) best = k;
      }
      if (miss(best) <= tolerance * delta_m) pairs.emplace_back(i, best);
    }
    return pairs;
  }
  std::vector<std::size_t> emitted;
  double since = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    since += way.at(i) - way[i - 1];
    if (since < delta_m) continue;
    emitted.push_back(i);
    since = 0;
  }
  for (std::size_t k = 1; k < emitted.size(); ++k) pairs.emplace_back(emitted[k - 1], emitted[k]);
  return pairs;
}

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

}  // namespace evaluation
