#include "tools/judge/evaluation/draws.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace evaluation {

std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0], b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key = {key[0] + 0x9E3779B9u, key[1] + 0xBB67AE85u};
  }
  return counter;
}

double Draws::Uniform() {
  if (used_ == 4) {
    bits_ = Philox({static_cast<std::uint32_t>(block_), static_cast<std::uint32_t>(block_ >> 32),
                    static_cast<std::uint32_t>(stream_), static_cast<std::uint32_t>(stream_ >> 32)},
                   {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
    ++block_;
    used_ = 0;
  }
  return (static_cast<double>(bits_[used_++]) + 0.5) * 0x1p-32;
}

double Draws::Normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(Uniform()));
  const double angle = 2 * M_PI * Uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::VectorXd Draws::Normals(Eigen::Index n) {
  Eigen::VectorXd values(n);
  for (double& value : values) value = Normal();
  return values;
}

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
