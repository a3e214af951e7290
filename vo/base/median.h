// Median of numbers, and its convention for an even count.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vo {

// The upper of the two in the middle. At least one value.
inline double UpperMedian(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace vo
