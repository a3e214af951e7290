// Ratio of RMS errors to the RMS of the Cramer-Rao bound (cramer_rao.h): statistical efficiency.
#pragma once

#include <array>
#include <vector>

#include "tools/judge/evaluation/consistency.h"

namespace evaluation {

// Over frames and runs, per block (p, phi, v, w).
struct BoundRatio {
  std::array<double, 4> overall{};        // sqrt(sum |e|^2 / sum tr B); NaN where no bound is above zero
  std::array<double, 4> rmse{}, bound{};  // root mean square [m, rad, m/s, rad/s]
};
// errors[run][frame], bounds[run][frame]. Throws std::logic_error where they are not as many.
BoundRatio CompareWithBound(const std::vector<std::vector<Vector12d>>& errors,
                            const std::vector<std::vector<Matrix12d>>& bounds);

}  // namespace evaluation
