#include "tools/judge/evaluation/square_root.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace evaluation {

SquareRoot SquareRootOf(const Eigen::MatrixXd& P) {
  constexpr double kPivot = 1e-12;
  const Eigen::VectorXd sigma = P.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd weight = (sigma.array() > 0).select(sigma.cwiseInverse(), 0);
  const Eigen::MatrixXd correlation = weight.asDiagonal() * P * weight.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(correlation);
  if (factor.info() == Eigen::Success) {
    const Eigen::MatrixXd L = factor.matrixL();
    if (L.diagonal().array().square().minCoeff() > kPivot) return {sigma.asDiagonal() * L, true};
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  return {sigma.asDiagonal() * solver.eigenvectors() * roots.asDiagonal(), false};
}

}  // namespace evaluation
