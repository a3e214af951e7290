#include "tools/judge/evaluation/association.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>

#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;

// Distance in seconds, as in the reference tools.
double Apart(std::int64_t a_ns, std::int64_t b_ns) { return std::abs(SecondsAsRead(a_ns) - SecondsAsRead(b_ns)); }

std::vector<double> SecondsOf(const Stamps& stamps) {
  std::vector<double> seconds(stamps.size());
  std::transform(stamps.begin(), stamps.end(), seconds.begin(), SecondsAsRead);
  return seconds;
}

// Bound on the rounding of a difference of two stamps as doubles.
constexpr std::int64_t kRounding_ns = 2000;

// Whether a pair has its neighbours on the same side in both trajectories. truth_of: the accepted pairs, by estimate.
bool GoesForward(const std::map<std::size_t, std::size_t>& truth_of, std::size_t i, std::size_t j) {
  const auto after = truth_of.lower_bound(i);
  return (after == truth_of.end() || after->second > j) && (after == truth_of.begin() || std::prev(after)->second < j);
}

std::vector<Match> OneToOne(const Stamps& estimate, const Stamps& truth, std::int64_t gap, bool may_cross) {
  const double gap_s = SecondsAsRead(gap);
  const std::vector<double> truth_s = SecondsOf(truth);
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const auto first = std::lower_bound(truth.begin(), truth.end(), estimate[i] - gap - kRounding_ns);
    const auto last = std::upper_bound(first, truth.end(), estimate[i] + gap + kRounding_ns);
    const double estimate_s = SecondsAsRead(estimate[i]);
    for (auto at = first; at != last; ++at) {
      const auto j = static_cast<std::size_t>(at - truth.begin());
      const double apart = std::abs(estimate_s - truth_s[j]);
      if (apart < gap_s) candidates.emplace_back(apart, i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::map<std::size_t, std::size_t> truth_of;
  std::vector<bool> truth_used(truth.size());
  for (const auto& [apart, i, j] : candidates) {
    if (truth_of.contains(i) || truth_used[j] || !(may_cross || GoesForward(truth_of, i, j))) continue;
    truth_of[i] = j;
    truth_used[j] = true;
  }
  std::vector<Match> matches;
  for (const auto& [i, j] : truth_of) matches.push_back({i, j});
  return matches;
}

std::vector<Match> NearestOfLonger(const Stamps& estimate, const Stamps& truth, std::int64_t gap) {
  std::vector<Match> matches;
  const bool estimate_longer = estimate.size() > truth.size();
  const Stamps& longer = estimate_longer ? estimate : truth;
  const Stamps& shorter = estimate_longer ? truth : estimate;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = NearestIndex(longer, shorter[i]);
    if (Apart(longer[j], shorter[i]) > SecondsAsRead(gap)) continue;
    matches.push_back(estimate_longer ? Match{j, i} : Match{i, j});
  }
  return matches;
}

std::string Span(const Trajectory& trajectory) {
  if (trajectory.empty()) return "nothing";
  return base::FormatSeconds(trajectory.front().stamp_ns) + " ... " + base::FormatSeconds(trajectory.back().stamp_ns) +
         " s";
}

}  // namespace

std::size_t NearestIndex(const std::vector<std::int64_t>& stamps, std::int64_t t) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), t);
  if (after == stamps.begin()) return 0;
  if (after == stamps.end()) return stamps.size() - 1;
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  return Apart(t, stamps[index - 1]) <= Apart(t, stamps[index]) ? index - 1 : index;
}

std::vector<std::int64_t> StampsOf(const Trajectory& trajectory) {
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : trajectory) stamps.push_back(pose.stamp_ns);
  return stamps;
}

std::vector<Match> Associate(const Stamps& estimate_ns, const Stamps& truth_ns, const AssociationOptions& options) {
  if (!std::is_sorted(estimate_ns.begin(), estimate_ns.end()) || !std::is_sorted(truth_ns.begin(), truth_ns.end())) {
    throw std::logic_error("Associate: stamps are not in order of time");
  }
  if (options.rule == AssociationRule::nearest) return NearestOfLonger(estimate_ns, truth_ns, options.gap_ns);
  return OneToOne(estimate_ns, truth_ns, options.gap_ns, options.rule == AssociationRule::tum);
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
                      base::Significant(static_cast<double>(options.gap_ns) * 1e-9, 6) + " s"});
  }
  return matched;
}

}  // namespace evaluation
