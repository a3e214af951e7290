// Size and whiteness of innovations: normalised innovation squared (NIS) per run and over runs, autocorrelation of a
// scalar normalised innovation.
// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with applications to tracking and navigation", 5.4; G. M. Ljung and
// G. E. P. Box, "On a measure of lack of fit in time series models", Biometrika 1978.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/judge/evaluation/distributions.h"

namespace evaluation {

// One sequence of numbers that should be independent, of equal variance.
struct Whiteness {
  std::size_t count = 0;
  std::vector<double> autocorrelation;  // at lags 1, 2, ...; about the mean
  double bound = 0;                     // 1.96 / sqrt(count): of each lag by itself, 95 %
  double ljung_box = 0;                 // N (N + 2) sum rho(l)^2 / (N - l)
  double p_value = 1;                   // chi-square with as many degrees of freedom as lags
};

// Fewer lags where the sequence is short (at most count - 1). A constant sequence has no answer: no lags, p-value 1.
Whiteness TestWhiteness(const std::vector<double>& sequence, int lags = 10);

// Many runs: each run's p-value is uniform if the innovations are white. Rejected when the runs with a p-value below
// 0.05 are more than the false-alarm quantile of a binomial of 0.05.
struct WhitenessVerdict {
  std::size_t runs = 0, rejected = 0;  // rejected at 5 % each
  std::size_t most_allowed = 0;
  std::vector<double> mean_autocorrelation;  // over runs, by lag
  double false_alarm = 0;
  bool pass = true;
};
WhitenessVerdict TestWhiteness(const std::vector<std::vector<double>>& sequences, int lags = 10,
                               double false_alarm = 0.01);

// NIS of white innovations: their sum over a run is chi-square with the sum of degrees of freedom.
struct NisBand {
  double nis = 0, dof = 0;
  double per_dof = 0;  // ideal 1
  Band band;           // 95 %, of per_dof
  bool inside = false;
};
// Values with dof <= 0 are left out.
NisBand NisOfRun(const std::vector<double>& nis, const std::vector<int>& dof);

// Rejected when more runs are outside their 95 % band than the false-alarm quantile of a binomial of 0.05.
struct NisVerdict {
  std::size_t runs = 0, outside = 0, most_allowed = 0;
  double per_dof = 0;  // over all
  double false_alarm = 0;
  bool pass = true;
};
NisVerdict TestNis(const std::vector<std::vector<double>>& nis, const std::vector<std::vector<int>>& dof,
                   double false_alarm = 0.01);

// NIS whose sum is no chi-square, because its terms depend on each other, but whose mean is the degrees of freedom: the
// mean over runs of each run's NIS per degree of freedom, with Student's t on the spread of the runs. With hundreds of
// thousands of degrees of freedom a thousandth is significant: rejected only where the mean is beyond 1 +- tolerance.
struct NisMeanVerdict {
  std::size_t runs = 0;
  double per_dof = 0;         // mean over runs
  double standard_error = 0;  // of it
  double low = 0, high = 0;   // 1 -+ (tolerance + t standard_error): passes within
  double false_alarm = 0;     // at most
  bool pass = true;
};
NisMeanVerdict TestNisMean(const std::vector<std::vector<double>>& nis, const std::vector<std::vector<int>>& dof,
                           double tolerance, double false_alarm = 0.01);

}  // namespace evaluation
