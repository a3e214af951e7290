#include "tools/judge/evaluation/rank_histogram.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/judge/evaluation/distributions.h"

namespace evaluation {
namespace {

// shares: of the range that each bin takes.
void Finish(RankHistogram& histogram, const std::vector<double>& shares) {
  histogram.shares = shares;
  for (const int count : histogram.counts) histogram.runs += count;
  if (histogram.runs == 0) return;
  for (std::size_t b = 0; b < shares.size(); ++b) {
    const double expected = histogram.runs * shares[b];
    const double off = histogram.counts[b] - expected;
    histogram.chi2 += off * off / expected;
  }
  histogram.p_value = Chi2Survival(histogram.chi2, static_cast<double>(shares.size()) - 1);
}

}  // namespace

RankHistogram HistogramOfRanks(const std::vector<int>& ranks, int draws, int bins) {
  if (bins < 2 || bins > draws + 1) {
    throw std::invalid_argument("HistogramOfRanks: " + std::to_string(bins) + " bins for ranks of 0 to " +
                                std::to_string(draws));
  }
  const auto bin_of = [&](int rank) { return static_cast<std::size_t>(static_cast<long>(rank) * bins / (draws + 1)); };
  std::vector<double> shares(static_cast<std::size_t>(bins));
  for (int rank = 0; rank <= draws; ++rank) shares[bin_of(rank)] += 1.0 / (draws + 1);
  RankHistogram histogram;
  histogram.counts.resize(shares.size());
  for (const int rank : ranks) {
    if (rank < 0 || rank > draws) {
      throw std::invalid_argument("HistogramOfRanks: rank " + std::to_string(rank) + " of 0 to " +
                                  std::to_string(draws));
    }
    ++histogram.counts[bin_of(rank)];
  }
  Finish(histogram, shares);
  return histogram;
}

RankHistogram HistogramOfValues(const std::vector<double>& values, int bins) {
  if (bins < 2) throw std::invalid_argument("HistogramOfValues: needs two bins, not " + std::to_string(bins));
  RankHistogram histogram;
  histogram.counts.resize(static_cast<std::size_t>(bins));
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (!(value >= 0) || !(value <= 1))
      throw std::invalid_argument("HistogramOfValues: " + std::to_string(value) + " is not in [0, 1]");
    ++histogram.counts[static_cast<std::size_t>(std::min(static_cast<int>(value * bins), bins - 1))];
  }
  Finish(histogram, std::vector<double>(static_cast<std::size_t>(bins), 1.0 / bins));
  return histogram;
}

UniformityVerdict TestUniformity(const std::vector<RankHistogram>& histograms, double false_alarm) {
  UniformityVerdict verdict;
  for (const RankHistogram& histogram : histograms) {
    if (histogram.runs == 0) continue;
    ++verdict.tests;
    verdict.smallest_p = std::min(verdict.smallest_p, histogram.p_value);
  }
  verdict.threshold = verdict.tests == 0 ? 0 : false_alarm / static_cast<double>(verdict.tests);
  verdict.pass = verdict.smallest_p >= verdict.threshold;
  return verdict;
}

int BinsFor(int runs) { return std::clamp(runs / 5, 2, 10); }

}  // namespace evaluation
