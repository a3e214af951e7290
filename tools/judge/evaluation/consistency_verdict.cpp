#include "tools/judge/evaluation/consistency_verdict.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace evaluation {
namespace {

// [run][frame] of one number, from first_frame on.
template <typename T, typename Get>
std::vector<std::vector<T>> Collect(const std::vector<VerdictRun>& runs, std::size_t first_frame, Get get) {
  std::vector<std::vector<T>> values(runs.size());
  for (std::size_t m = 0; m < runs.size(); ++m)
    for (std::size_t k = first_frame; k < runs[m].size(); ++k) values[m].push_back(get(runs[m][k]));
  return values;
}

ExactAnees ExactOf(const VerdictOptions& options, const StateBlock& block, int runs, int frames) {
  if (!options.linearised.empty()) {
    std::vector<std::vector<double>> nees;
    for (const LinearisedRuns& world : options.linearised) {
      for (auto& run : NeesOf(world, block.start, block.size)) {
        run.erase(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(std::min(options.first_frame, run.size())));
        nees.push_back(std::move(run));
      }
    }
    return ExactAneesOfPool(nees, block.size, runs, options.trials);
  }
  LinearFilter filter = options.reference;
  const bool joint = block.size == 12;
  filter.axes = joint ? 6 : block.size;
  filter.judged = joint              ? LinearFilter::Judged::both
                  : block.start >= 6 ? LinearFilter::Judged::velocity
                                     : LinearFilter::Judged::position;
  return ExactAneesOf(filter, runs, frames, options.trials);
}

std::vector<std::size_t> RankFrames(const VerdictOptions& options, std::size_t frames) {
  if (!options.rank_frames.empty()) return options.rank_frames;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 1; i <= 4; ++i) {
    const std::size_t k = options.first_frame + (frames - 1 - options.first_frame) * i / 4;
    if (chosen.empty() || chosen.back() != k) chosen.push_back(k);
  }
  return chosen;
}

void JudgeRanks(const std::vector<VerdictRun>& runs, const VerdictOptions& options, std::size_t frames,
                ConsistencyVerdict& verdict) {
  std::vector<RankHistogram> coverage;
  for (const std::size_t k : RankFrames(options, frames)) {
    std::vector<const MixtureScores*> ranked;  // none of a run that is lost by then, or has no belief
    for (const VerdictRun& run : runs)
      if (k < run.size() && run[k].scores.draws > 0) ranked.push_back(&run[k].scores);
    if (ranked.empty()) {
      verdict.rank_histograms.resize(verdict.rank_histograms.size() + 12);
      continue;
    }
    const int draws = ranked.front()->draws, bins = BinsFor(static_cast<int>(ranked.size()));
    if (std::ranges::any_of(ranked, [&](const MixtureScores* scores) { return scores->draws != draws; }))
      throw std::invalid_argument("JudgeConsistency: ranks among different numbers of draws");
    for (std::size_t d = 0; d < 12; ++d) {
      std::vector<int> ranks;
      for (const MixtureScores* scores : ranked) ranks.push_back(scores->rank[d]);
      verdict.rank_histograms.push_back(HistogramOfRanks(ranks, draws, std::min(bins, draws + 1)));
    }
    for (std::size_t b = 4; b < kStateBlocks.size(); ++b) {  // pose, velocity, joint
      std::vector<double> masses;
      for (const MixtureScores* scores : ranked) masses.push_back(scores->hpd_mass[b]);
      coverage.push_back(HistogramOfValues(masses, bins));
    }
  }
  const auto add = [&](const char* name, const std::vector<RankHistogram>& histograms) {
    const UniformityVerdict test = TestUniformity(histograms, options.false_alarm);
    if (test.tests > 0)
      verdict.checks.push_back({name, test.smallest_p, test.threshold, true, test.pass, options.false_alarm});
    return test.tests > 0;
  };
  if (!add("ranks, smallest p-value", verdict.rank_histograms)) verdict.rank_histograms.clear();
  add("coverage, smallest p-value", coverage);
}

void JudgeInnovations(const std::vector<VerdictRun>& runs, const VerdictOptions& options, ConsistencyVerdict& verdict) {
  const auto nis = Collect<double>(runs, options.first_frame, [](const JudgedFrame& f) { return f.nis; });
  const auto dof = Collect<int>(runs, options.first_frame, [](const JudgedFrame& f) { return f.nis_dof; });
  auto innovations = Collect<double>(runs, options.first_frame, [](const JudgedFrame& f) { return f.innovation; });
  for (auto& run : innovations) std::erase_if(run, [](double value) { return std::isnan(value); });
  const NisMeanVerdict mean = TestNisMean(nis, dof, options.nis_tolerance, options.false_alarm);
  if (mean.runs > 0) {
    verdict.nis_mean = mean;
    const bool low = mean.per_dof < 1;
    verdict.checks.push_back(
        {"NIS / dof, mean over runs", mean.per_dof, low ? mean.low : mean.high, low, mean.pass, options.false_alarm});
  }
  const WhitenessVerdict white = TestWhiteness(innovations, 10, options.false_alarm);
  if (white.runs > 0) {
    verdict.whiteness = white;
    verdict.checks.push_back({"whiteness, runs rejected at 5 %", static_cast<double>(white.rejected),
                              static_cast<double>(white.most_allowed), false, white.pass, options.false_alarm});
  }
}

void CompareRunsWithBound(const std::vector<VerdictRun>& runs, const VerdictOptions& options,
                          ConsistencyVerdict& verdict) {
  std::vector<std::vector<Vector12d>> errors(runs.size());
  std::vector<std::vector<Matrix12d>> bounds(runs.size());
  for (std::size_t m = 0; m < runs.size(); ++m) {
    for (std::size_t k = options.first_frame; k < runs[m].size(); ++k) {
      if (!runs[m][k].bound) continue;
      errors[m].push_back(runs[m][k].error);
      bounds[m].push_back(*runs[m][k].bound);
    }
  }
  if (std::ranges::all_of(bounds, [](const auto& run) { return run.empty(); })) return;
  const BoundRatio ratio = CompareWithBound(errors, bounds);
  for (std::size_t b = 0; b < 4; ++b) {
    verdict.checks.push_back({std::string("RMSE / bound, ") + kStateBlocks[b].name, ratio.overall[b],
                              options.largest_bound_ratio, false, ratio.overall[b] <= options.largest_bound_ratio, 0});
  }
}

}  // namespace

bool ConsistencyVerdict::pass() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.pass; });
}

bool ConsistencyVerdict::consistent() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const Check& check) { return check.pass || check.name.starts_with("RMSE / bound"); });
}

double ConsistencyVerdict::false_alarm() const {
  double sum = 0;
  for (const Check& check : checks) sum += check.false_alarm;
  return sum;
}

ConsistencyVerdict JudgeConsistency(const std::vector<VerdictRun>& runs, const VerdictOptions& options) {
  std::size_t frames = 0;
  for (const VerdictRun& run : runs) frames = std::max(frames, run.size());
  if (frames <= options.first_frame) throw std::invalid_argument("JudgeConsistency: no run has a frame to judge");
  ConsistencyVerdict verdict;
  const auto count = static_cast<int>(runs.size());
  std::size_t missing = 0;  // frames lost, or with an invalid covariance
  for (const VerdictRun& run : runs) {
    for (std::size_t k = options.first_frame; k < frames; ++k)
      missing += k >= run.size() || std::isnan(run[k].scores.nees.back());
  }
  verdict.checks.push_back({"frames without a belief", static_cast<double>(missing), 0, false, missing == 0, 0});
  for (std::size_t b = 0; b < kStateBlocks.size(); ++b) {
    const auto nees =
        Collect<double>(runs, options.first_frame, [&](const JudgedFrame& frame) { return frame.scores.nees[b]; });
    const auto exact = ExactOf(options, kStateBlocks[b], count, static_cast<int>(frames - options.first_frame));
    verdict.anees.push_back(TestAnees(nees, kStateBlocks[b].size, exact, options.false_alarm));
    const AneesVerdict& anees = verdict.anees.back();
    const std::string name = kStateBlocks[b].name;
    verdict.checks.push_back(
        {"ANEES share, " + name, anees.measured.share, anees.threshold, true, anees.share_pass, options.false_alarm});
    const bool low = anees.measured.mean < 1;  // the side of the deviation
    verdict.checks.push_back({"ANEES mean, " + name, anees.measured.mean, low ? anees.mean_low : anees.mean_high, low,
                              anees.mean_pass, options.false_alarm});
  }
  JudgeRanks(runs, options, frames, verdict);
  JudgeInnovations(runs, options, verdict);
  CompareRunsWithBound(runs, options, verdict);
  std::array<double, 4> with_energy{};
  double judged = 0;
  for (const VerdictRun& run : runs) {
    for (std::size_t k = options.first_frame; k < run.size(); ++k, ++judged) {
      verdict.effective_components += run[k].scores.effective_components;
      for (std::size_t b = 0; b < 4; ++b) {
        if (run[k].scores.draws == 0 || std::isnan(run[k].scores.energy[b])) continue;
        verdict.energy[b] += run[k].scores.energy[b];
        ++with_energy[b];
      }
    }
  }
  for (std::size_t b = 0; b < 4; ++b) verdict.energy[b] /= with_energy[b];
  verdict.effective_components /= judged;
  return verdict;
}

}  // namespace evaluation
