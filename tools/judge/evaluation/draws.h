// Counter-based random numbers of the evaluation: each a function of (seed, stream, index).
// Source: Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011 (Philox 4x32-10); Box-Muller.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace evaluation {

// Philox 4x32 with ten rounds, as Random123 has it.
std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

// The stream named by (seed, stream): each call gives its next number.
class Draws {
 public:
  explicit Draws(std::uint64_t seed, std::uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  // On the open interval (0, 1), 2^-32 apart.
  double Uniform();
  // Standard normal; at most 6.7 sigma.
  double Normal();
  Eigen::VectorXd Normals(Eigen::Index n);

 private:
  std::uint64_t seed_, stream_, block_ = 0;
  std::array<std::uint32_t, 4> bits_{};
  unsigned used_ = 4;
  double spare_ = 0;
  bool has_spare_ = false;
};

// Square root of a covariance, also of a singular one, for drawing and for densities.
// P = L L'. `full`: P is positive definite (the least pivot of its correlations, which have no unit, is above 1e-12)
// and L is its lower triangle; else L is made of eigenvectors, with negative eigenvalues of P set to zero.
struct SquareRoot {
  Eigen::MatrixXd L;
  bool full = false;
};
SquareRoot SquareRootOf(const Eigen::MatrixXd& P);

}  // namespace evaluation
