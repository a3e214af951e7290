// Dose-response of an estimator under stress: a statistic per dose with its uncertainty, and the dose at which half
// of the runs have failed.
// Source: Efron and Tibshirani, "An introduction to the bootstrap" (1993), 13.3, percentile intervals; Ayer et al., "An
// empirical distribution function for sampling with incomplete information" (1955), pool adjacent violators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace evaluation {

// One run. Runs of one block (a seed) are resampled together: their errors are correlated across doses.
struct DoseRun {
  std::size_t dose = 0;  // 0, 1, ...: the mildest first
  std::size_t block = 0;
  double value = 0;  // in the metric's unit; +inf (or -inf) of a run that is worse than any number, NaN: there is none
};

struct BootstrapOptions {
  double level = 0.95;  // of the intervals
  int resamples = 2000;
  std::uint64_t seed = 1;  // of the resampling; another one moves the ends by little
};

// Estimate over the runs of one dose that have a value; NaN where there is none.
struct DoseEstimate {
  std::size_t runs = 0;
  double value = 0, low = 0, high = 0;
};

// The median of each dose 0 ... doses - 1, or for a share (values 0 and 1) the mean. Infinite where half of the runs
// are. Results do not depend on the order of the runs, and on the numbers of blocks only by their order. Throws
// std::invalid_argument where a run's dose is not below `doses`, or for invalid options.
std::vector<DoseEstimate> MediansByDose(std::size_t doses, const std::vector<DoseRun>& runs,
                                        const BootstrapOptions& options = {});
std::vector<DoseEstimate> MeansByDose(std::size_t doses, const std::vector<DoseRun>& runs,
                                      const BootstrapOptions& options = {});

// Isotonic regression: weighted least squares among non-decreasing sequences; values of weight 0 are ignored and get
// the value of the last one before them with weight (NaN where there is none).
std::vector<double> IsotonicFit(const std::vector<double>& values, const std::vector<double>& weights);

// Crossing of one half by a share of runs.
struct Crossing {
  enum class Kind {
    at_the_first,  // half have failed at the mildest dose already
    inside,
    not_reached,  // not half have failed at the strongest
  };
  Kind kind = Kind::not_reached;
  double dose = 0;  // of inside; in the unit of the doses
};

struct BreakingPoint {
  Crossing at;
  // Confidence interval: from the smallest dose that the bootstrap leaves unbroken to the largest that it breaks; never
  // narrower than the spacing of the doses, between which nothing was measured.
  Crossing low, high;
};

// Whether the spacing of doses is geometric rather than arithmetic: all positive, and their ratios more equal than
// their differences.
bool AreGeometric(const std::vector<double>& doses);

// Failed runs have the value 1, others 0. The share of failures is made monotone (IsotonicFit, weighted by runs) and
// interpolated linearly, in the logarithm of the dose where doses are geometric. `doses` in order of stress, strictly
// rising or strictly falling; none where no run has a value. Throws std::invalid_argument otherwise.
std::optional<BreakingPoint> FindBreakingPoint(const std::vector<double>& doses, const std::vector<DoseRun>& failures,
                                               const BootstrapOptions& options = {});

}  // namespace evaluation
