// Breaking point of a share that is logistic in the dose, with an interval by profile likelihood.
// With few doses chi-square in place of t^2 is too narrow: its coverage was 82 to 94 % instead of 90 %.
// Source: Finney, "Probit analysis" (1971), with the logistic in place of the normal; Venzon and Moolgavkar, "A method
// for computing profile-likelihood-based confidence intervals" (1988).
//
//   P(broken at x) = 1 / (1 + exp(-k (x - m))),  k > 0;  m is the breaking point
//
// Runs must be independent of each other, at one dose and between doses.
#pragma once

#include <optional>
#include <vector>

namespace evaluation {

struct BrokenCount {
  double dose = 0;
  int runs = 0, broken = 0;
};

struct LogisticBreak {
  double at = 0;    // m of the largest likelihood; the middle of all of them where many are alike
  double low = 0;   // those m whose profile log-likelihood is less than t^2 / 2 below the largest, t the quantile of
  double high = 0;  // Student's distribution with doses - 2 degrees of freedom: -inf or +inf at an end of the search
  double steepness = 0;  // k; at its largest where all runs below m are whole and all above are broken
};

// Doses are on a scale on which 0 is the mildest and 1 the most severe; m is searched from -0.5 to 1.5 in steps of
// 1/400, k from 3 to 1000. None without a run. Throws std::invalid_argument where a count is negative or more are
// broken than ran, and where `level` is not between 0 and 1.
std::optional<LogisticBreak> FitLogisticBreak(const std::vector<BrokenCount>& counts, double level = 0.9);

}  // namespace evaluation
