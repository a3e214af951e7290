#include "tools/evaluation/association.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "tools/evaluation/text_file.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;

std::vector<Match> OneToOne(const Stamps& estimate, const Stamps& truth, std::int64_t gap) {
  std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> candidates;
  std::size_t first = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    while (first < truth.size() && truth[first] <= estimate[i] - gap) ++first;
    for (std::size_t j = first; j < truth.size() && truth[j] < estimate[i] + gap; ++j) {
      candidates.emplace_back(std::abs(estimate[i] - truth[j]), i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> estimate_used(estimate.size()), truth_used(truth.size());
  std::vector<Match> matches;
  for (const auto& [difference, i, j] : candidates) {
    if (estimate_used[i] || truth_used[j]) continue;
    estimate_used[i] = truth_used[j] = true;
    matches.push_back({i, j});
  }
  std::sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) { return a.estimate < b.estimate; });
  return matches;
}

// Index of the stamp nearest to t, the earlier one of two equally near. stamps not empty, in order.
std::size_t Nearest(const Stamps& stamps, std::int64_t t) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), t);
  if (after == stamps.begin()) return 0;
  if (after == stamps.end()) return stamps.size() - 1;
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  return t - stamps[index - 1] <= stamps[index] - t ? index - 1 : index;
}

std::vector<Match> NearestOfLonger(const Stamps& estimate, const Stamps& truth, std::int64_t gap) {
  std::vector<Match> matches;
  const bool estimate_longer = estimate.size() > truth.size();
  const Stamps& longer = estimate_longer ? estimate : truth;
  const Stamps& shorter = estimate_longer ? truth : estimate;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = Nearest(longer, shorter[i]);
    if (std::abs(longer[j] - shorter[i]) > gap) continue;
    matches.push_back(estimate_longer ? Match{j, i} : Match{i, j});
  }
  return matches;
}

std::vector<Match> ForwardScan(const Stamps& estimate, const Stamps& truth, std::int64_t gap) {
  std::vector<Match> matches;
  std::size_t next = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    while (next < truth.size() && truth[next] <= estimate[i] - gap) ++next;
    std::int64_t best = gap;
    const std::size_t begin = next;
    while (next < truth.size() && std::abs(truth[next] - estimate[i]) < best) {
      best = std::abs(truth[next] - estimate[i]);
      ++next;
    }
    if (next > begin) matches.push_back({i, next - 1});
  }
  return matches;
}

Stamps StampsOf(const Trajectory& trajectory) {
  Stamps stamps;
  for (const StampedPose& pose : trajectory) stamps.push_back(pose.stamp_ns);
  return stamps;
}

std::string Span(const Trajectory& trajectory) {
  if (trajectory.empty()) return "nothing";
  return FormatSeconds(trajectory.front().stamp_ns) + " ... " + FormatSeconds(trajectory.back().stamp_ns) + " s";
}

}  // namespace

std::vector<Match> Associate(const Stamps& estimate_ns, const Stamps& truth_ns, const AssociationOptions& options) {
  if (estimate_ns.empty() || truth_ns.empty()) return {};
  switch (options.rule) {
    case AssociationRule::nearest:
      return NearestOfLonger(estimate_ns, truth_ns, options.gap_ns);
    case AssociationRule::forward_scan:
      return ForwardScan(estimate_ns, truth_ns, options.gap_ns);
    case AssociationRule::one_to_one:
      break;
  }
  return OneToOne(estimate_ns, truth_ns, options.gap_ns);
}

MatchedTrajectories MatchTrajectories(const Trajectory& estimate, const Trajectory& truth,
                                      const AssociationOptions& options) {
  MatchedTrajectories matched;
  for (const Match& match : Associate(StampsOf(estimate), StampsOf(truth), options)) {
    matched.estimate.push_back(estimate[match.estimate]);
    matched.truth.push_back(truth[match.truth]);
  }
  if (matched.estimate.empty()) {
    throw InputError({"estimate and truth have no pose in common: the estimate covers " + Span(estimate) +
                      ", the truth " + Span(truth) + ", and the gap allowed between stamps is " +
                      FormatNumber(static_cast<double>(options.gap_ns) * 1e-9, 6) + " s"});
  }
  return matched;
}

}  // namespace evaluation
