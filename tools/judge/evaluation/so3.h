// Rotation formulas of the evaluation: independent of the filter's, so that a common mistake cannot cancel.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace evaluation {

// Rotation vector of a unit quaternion, angle in [0, pi] [rad].
inline Eigen::Vector3d Log(const Eigen::Quaterniond& q) {
  const double n = q.vec().norm();
  const double sign = q.w() < 0 ? -1 : 1;
  if (n < 1e-10) return 2 * sign * q.vec();  // 2 n (1 + O(n^2)) / n
  return sign * 2 * std::atan2(n, std::abs(q.w())) / n * q.vec();
}

// Unit quaternion of a rotation vector [rad].
inline Eigen::Quaterniond Exp(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double k = angle < 1e-10 ? 0.5 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = k * phi;
  return q;
}

// Angle of the rotation between two orientations, in [0, pi] [rad].
inline double AngleBetween(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return Log(a.conjugate() * b).norm();
}

}  // namespace evaluation
