// Summary statistics of a list of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace evaluation {

// In the unit of the values; all zero when there are none (count says so).
struct Statistics {
  std::size_t count = 0;
  double rmse = 0, mean = 0, median = 0;  // median: mean of the middle two when count is even
  double std = 0;                         // about the mean, divided by count
  double min = 0, max = 0;
};

Statistics Summarise(const std::vector<double>& values);

// The middle value (mean of the middle two); NaN when empty.
double Median(std::vector<double> values);

// The value below which a share (0 to 1) of the sorted values lies: between the two nearest, linearly; next to an
// infinite one, that. NaN when empty.
double Quantile(const std::vector<double>& sorted, double share);

}  // namespace evaluation
