// Summary statistics of a list of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace evaluation {

// In the unit of the values; all zero for an empty list (count 0).
struct Statistics {
  std::size_t count = 0;
  double rmse = 0, mean = 0, median = 0;  // median: mean of the middle two when count is even
  double std = 0;                         // about the mean, divided by count
  double min = 0, max = 0;
};

Statistics Summarise(const std::vector<double>& values);

// The middle value (mean of the middle two); NaN when empty.
double Median(std::vector<double> values);

// Quantile of the sorted values at a share (0 to 1), by linear interpolation between the two nearest; next to an
// infinite one, that. NaN when empty.
double Quantile(const std::vector<double>& sorted, double share);

}  // namespace evaluation
