// Purpose: the symmetric matrix beside one that is so but for rounding. Where most of what is multiplied cancels (two images within a
//          millisecond, then none for seconds), rounding is far above that of the result's own size.
#pragma once

#include <Eigen/Core>

namespace vo {

// The mean of both halves.
template <class Derived>
typename Derived::PlainObject Symmetrised(const Eigen::MatrixBase<Derived>& product) {
  const auto& P = product.eval();
  return 0.5 * (P + P.transpose());
}

// In place, from the lower half.
inline void Symmetrise(Eigen::MatrixXd& P) { P.triangularView<Eigen::StrictlyUpper>() = P.transpose(); }

}  // namespace vo
