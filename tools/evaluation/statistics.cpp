#include "tools/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evaluation {

double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

Statistics Summarise(const std::vector<double>& values) {
  Statistics s;
  if (values.empty()) return s;
  s.count = values.size();
  const double n = static_cast<double>(s.count);
  double squares = 0;
  for (const double value : values) {
    s.mean += value / n;
    squares += value * value / n;
  }
  double about_mean = 0;
  for (const double value : values) about_mean += (value - s.mean) * (value - s.mean) / n;
  s.rmse = std::sqrt(squares);
  s.std = std::sqrt(about_mean);
  s.median = Median(values);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  s.min = *low;
  s.max = *high;
  return s;
}

}  // namespace evaluation
