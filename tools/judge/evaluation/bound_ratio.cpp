#include "tools/judge/evaluation/bound_ratio.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace evaluation {

BoundRatio CompareWithBound(const std::vector<std::vector<Vector12d>>& errors,
                            const std::vector<std::vector<Matrix12d>>& bounds) {
  std::array<double, 4> squares{}, traces{};
  double count = 0;
  if (errors.size() != bounds.size()) throw std::logic_error("CompareWithBound: a run without its bound");
  for (std::size_t m = 0; m < errors.size(); ++m) {
    if (errors[m].size() != bounds[m].size()) throw std::logic_error("CompareWithBound: a frame without its bound");
    for (std::size_t k = 0; k < errors[m].size(); ++k) {
      for (std::size_t b = 0; b < 4; ++b) {
        const auto start = 3 * static_cast<Eigen::Index>(b);
        squares[b] += errors[m][k].segment<3>(start).squaredNorm();
        traces[b] += bounds[m][k].diagonal().segment<3>(start).sum();
      }
      ++count;
    }
  }
  BoundRatio result;
  for (std::size_t b = 0; b < 4; ++b) {
    result.overall[b] = traces[b] > 0 ? std::sqrt(squares[b] / traces[b]) : std::numeric_limits<double>::quiet_NaN();
    result.rmse[b] = std::sqrt(squares[b] / count);
    result.bound[b] = std::sqrt(traces[b] / count);
  }
  return result;
}

}  // namespace evaluation
