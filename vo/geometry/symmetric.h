// Purpose: the symmetric matrix beside a product that is one but for rounding. Where most of what is multiplied cancels (two images within a
//          millisecond, then none for seconds), rounding is far above that of the result's own size.
#pragma once

#include <Eigen/Core>

namespace vo {

template <class Derived>
typename Derived::PlainObject Symmetrised(const Eigen::MatrixBase<Derived>& product) {
  const typename Derived::PlainObject P = product;
  return 0.5 * (P + P.transpose());
}

}  // namespace vo
