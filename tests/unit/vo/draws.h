// Random numbers of the odometry's tests, equal for all compilers: std::mt19937_64 is specified bit by bit, and vectors
// are drawn element by element, since C++ leaves the order in which arguments are evaluated unspecified.
// Source: Box and Muller 1958.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace vo_test {

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : bits_(seed) {}

  // On the open interval (0, 1).
  double Uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1.0p-53; }
  // On (-1, 1).
  double Symmetric() { return 2 * Uniform() - 1; }
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(Uniform()));
    return radius * std::cos(2 * std::numbers::pi * Uniform());
  }

  template <int N>
  Eigen::Vector<double, N> Symmetrics() {
    return Filled<N>([this] { return Symmetric(); });
  }
  template <int N>
  Eigen::Vector<double, N> Normals() {
    return Filled<N>([this] { return Normal(); });
  }

 private:
  template <int N, class Next>
  static Eigen::Vector<double, N> Filled(Next next) {
    Eigen::Vector<double, N> v;
    for (double& x : v) x = next();
    return v;
  }

  std::mt19937_64 bits_;
};

}  // namespace vo_test
