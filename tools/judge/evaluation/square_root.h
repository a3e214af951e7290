// Square root of a covariance, also of a singular one, for drawing and for densities.
#pragma once

#include <Eigen/Core>

namespace evaluation {

// P = L L'. `full`: P is positive definite (the least pivot of its correlations, which have no unit, is above 1e-12)
// and L is its lower triangle; else L is made of eigenvectors, and what is negative of P counts as zero.
struct SquareRoot {
  Eigen::MatrixXd L;
  bool full = false;
};
SquareRoot SquareRootOf(const Eigen::MatrixXd& P);

}  // namespace evaluation
