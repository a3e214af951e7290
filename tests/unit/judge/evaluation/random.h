// Random numbers of the judge's tests: a function of (seed, index), the same everywhere.
// Source: Random123, Philox 4x32-10; Box-Muller.
#pragma once

#include <Random123/philox.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

// Stream of random numbers, defined by its seed.
class TestRandom {
 public:
  explicit TestRandom(std::uint32_t seed) : seed_(seed) {}

  // On the open interval (0, 1).
  double Uniform() {
    const auto bits = r123::Philox4x32()({{count_++, 0, 0, 0}}, {{seed_, 0}});
    return (static_cast<double>(bits[0]) * 0x1p32 + static_cast<double>(bits[1]) + 0.5) * 0x1p-64;
  }
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(Uniform()));
    return radius * std::cos(2 * M_PI * Uniform());
  }
  Eigen::VectorXd Normals(int n) {
    Eigen::VectorXd values(n);
    for (double& value : values) value = Normal();
    return values;
  }
  Eigen::Quaterniond Orientation() {
    const Eigen::Vector4d q = Normals(4).normalized();
    return Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  }
  // Random walk of poses, dt apart.
  Trajectory Walk(int poses, std::int64_t dt_ns = 33'333'333, double step_m = 0.05, double step_rad = 0.05) {
    Trajectory trajectory{{1'000'000'000, Normals(3), Orientation()}};
    while (static_cast<int>(trajectory.size()) < poses) {
      const StampedPose& last = trajectory.back();
      trajectory.push_back(
          {last.stamp_ns + dt_ns, last.p_WC + step_m * Normals(3), last.q_WC * Exp(step_rad * Normals(3))});
    }
    return trajectory;
  }

 private:
  std::uint32_t seed_, count_ = 0;
};

}  // namespace evaluation
