// Size and whiteness of innovations: normalised innovation squared (NIS) per run and over runs, autocorrelation of a
// scalar normalised innovation.
// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation", 5.4; G. M. Ljung and
// G. E. P. Box, "On a measure of lack of fit in time series models", Biometrika 1978.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/estimate_run.h"

namespace evaluation {

// NIS nu' S^-1 nu of one run by frames; needs no truth.
struct NisSummary {
  std::size_t frames = 0;  // with at least one matched feature
  // NaN where there is no such frame: sum of NIS / sum of degrees of freedom; ideal 1
  double mean_per_dof = std::numeric_limits<double>::quiet_NaN();
  // Of frames inside the two-sided 95 % chi-square band of their own degrees of freedom; ideal 0.95, NaN as above
  double share_inside = std::numeric_limits<double>::quiet_NaN();
  // Autocorrelation, at lags 1 to 5 frames, of z_k = (NIS_k - dof_k) / sqrt(dof_k). White innovations give values
  // within +-1.96/sqrt(frames), 95 % each. The innovations themselves are not recorded: only dependence of their size
  // is detected.
  std::vector<double> autocorrelation;
  double whiteness_bound = 0;
};

// Gating drops large innovations, so a consistent gated filter sits slightly below 1.
NisSummary SummariseNis(const std::vector<FrameRecord>& frames);

// Test of one sequence of numbers for independence, at equal variance.
struct Whiteness {
  std::vector<double> autocorrelation;  // at lags 1, 2, ...; about the mean
  double bound = 0;                     // 1.96 / sqrt(N): of each lag by itself, 95 %
  // Of Ljung and Box's N (N + 2) sum rho(l)^2 / (N - l): chi-square with as many degrees of freedom as lags
  double p_value = 1;
};

// Fewer lags where the sequence is short (at most N - 1). A constant sequence is undefined: no lags, p-value 1.
Whiteness TestWhiteness(const std::vector<double>& sequence, int lags = 10);

// Many runs: each run's p-value is uniform if the innovations are white. Rejected when the runs with a p-value below
// 0.05 are more than the false-alarm quantile of a binomial of 0.05.
struct WhitenessVerdict {
  std::size_t runs = 0, rejected = 0;  // rejected at 5 % each
  std::size_t most_allowed = 0;
  std::vector<double> mean_autocorrelation;  // over runs, by lag
  bool pass = true;
};
WhitenessVerdict TestWhiteness(const std::vector<std::vector<double>>& sequences, int lags = 10,
                               double false_alarm = 0.01);

// Mean over runs of each run's NIS per degree of freedom, with Student's t on the spread of the runs: the terms of a
// run may depend on each other, as the NIS of features that share the error of the pose. With hundreds of thousands of
// degrees of freedom a thousandth is significant: rejected only where the mean is beyond 1 +- tolerance.
struct NisMeanVerdict {
  std::size_t runs = 0;       // with a degree of freedom
  double per_dof = 0;         // mean over runs
  double standard_error = 0;  // of it
  double low = 0, high = 0;   // 1 -+ (tolerance + t standard_error): passes within
  bool pass = true;
};
NisMeanVerdict TestNisMean(const std::vector<std::vector<double>>& nis, const std::vector<std::vector<int>>& dof,
                           double tolerance, double false_alarm = 0.01);

}  // namespace evaluation
