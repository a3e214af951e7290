// Uniformity test of ranks (or PIT values, or HPD masses) of the truth over runs: simulation-based calibration.
// Source: Talts et al. 2018; Pearson's chi-square. A histogram is over runs only: frames of one run are dependent.
#pragma once

#include <string>
#include <vector>

namespace evaluation {

struct RankHistogram {
  std::vector<int> counts;     // per bin
  std::vector<double> shares;  // of all ranks, that each bin takes
  int runs = 0;
  double chi2 = 0;     // sum (count - expected)^2 / expected
  double p_value = 1;  // of uniformity: chi-square with bins - 1 degrees of freedom
};

// ranks[m] of run m in 0 ... draws. Bins are as even as whole ranks allow and expected counts follow their widths.
// Throws std::invalid_argument for a rank outside and for fewer than two bins or more than draws + 1.
RankHistogram HistogramOfRanks(const std::vector<int>& ranks, int draws, int bins = 10);

// values[m] of run m in [0, 1]; NaN is left out.
RankHistogram HistogramOfValues(const std::vector<double>& values, int bins = 10);

// Several histograms (dimensions and chosen frames) as one test: rejected if the smallest p-value times their number is
// below the false-alarm rate (Bonferroni: no independence is needed, and the rate is an upper bound).
struct UniformityVerdict {
  double smallest_p = 1;  // of a single histogram
  std::size_t tests = 0;
  double threshold = 0;  // of smallest_p: false_alarm, of the whole, / tests
  bool pass = true;
};

UniformityVerdict TestUniformity(const std::vector<RankHistogram>& histograms, double false_alarm = 0.01);

// So many runs for five in every bin, at least 2 and at most 10 bins.
int BinsFor(int runs);

}  // namespace evaluation
