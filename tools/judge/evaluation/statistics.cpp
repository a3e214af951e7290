#include "tools/judge/evaluation/statistics.h"

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

double Quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double rest = at - static_cast<double>(below);
  if (rest == 0) return sorted[below];
  if (std::isinf(sorted[below])) return sorted[below];  // inf - inf is NaN
  return sorted[below] + rest * (sorted[below + 1] - sorted[below]);
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
  for (const double value : values) {
    const double off = value - s.mean;
    about_mean += off * off / n;
  }
  s.rmse = std::sqrt(squares);
  s.std = std::sqrt(about_mean);
  s.median = Median(values);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  s.min = *low;
  s.max = *high;
  return s;
}

}  // namespace evaluation
