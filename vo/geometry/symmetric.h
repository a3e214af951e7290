// Symmetric part of a matrix: restores the symmetry of a covariance that rounding has lost. Where large terms cancel
// (two images within a millisecond, then none for seconds) the asymmetry is far above the result's own precision.
#pragma once

#include <Eigen/Core>

namespace vo {

// (P + P') / 2.
template <class Derived>
typename Derived::PlainObject Symmetrised(const Eigen::MatrixBase<Derived>& product) {
  const auto& P = product.eval();
  return 0.5 * (P + P.transpose());
}

// In place: copies the lower triangle to the upper one.
inline void Symmetrise(Eigen::MatrixXd& P) { P.triangularView<Eigen::StrictlyUpper>() = P.transpose(); }

}  // namespace vo
