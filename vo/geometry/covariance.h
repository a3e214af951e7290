// Covariance matrices: their symmetric part, and the root of a semi-definite one.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace vo {

// Symmetric part (P + P') / 2: restores the symmetry that rounding has lost. Where large terms cancel (two images
// within a millisecond, then none for seconds) the asymmetry is far above the result's own precision.
template <class Derived>
typename Derived::PlainObject Symmetrised(const Eigen::MatrixBase<Derived>& product) {
  const auto& P = product.eval();
  return 0.5 * (P + P.transpose());
}

// In place: copies the lower triangle to the upper one.
inline void Symmetrise(Eigen::MatrixXd& P) { P.triangularView<Eigen::StrictlyUpper>() = P.transpose(); }

// C with C C' = P. A column is 0 where P has no variance left; P need only be semi-definite.
template <int N>
Eigen::Matrix<double, N, N> SemidefiniteRoot(const Eigen::Matrix<double, N, N>& P) {
  Eigen::Matrix<double, N, N> C = Eigen::Matrix<double, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    const double pivot = P(j, j) - C.row(j).squaredNorm();
    if (pivot <= 1e-14 * P(j, j)) continue;
    C(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) C(i, j) = (P(i, j) - C.row(i).dot(C.row(j))) / C(j, j);
  }
  return C;
}

}  // namespace vo
