// SO(3) as unit quaternions: exponential, logarithm, right Jacobian and its inverse.
// Source:  Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", (132)-(147).
// Frames:  right perturbation, q = q_hat (x) Exp(phi), phi in the body (camera) frame.
// Units:   radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace vo {

inline Eigen::Matrix3d Hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Eigen::Quaterniond Exp(const Eigen::Vector3d& phi) {
  const double angle_sq = phi.squaredNorm();
  const double angle = std::sqrt(angle_sq);
  const double k = angle < 1e-4 ? 0.5 - angle_sq / 48.0 : std::sin(0.5 * angle) / angle;  // error < 1e-19 below 1e-4
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = k * phi;
  return q;
}

// Rotation vector of length at most pi.
inline Eigen::Vector3d Log(const Eigen::Quaterniond& q) {
  const double n = q.vec().norm();
  const double w = q.w();
  if (n < 1e-9) return (2.0 / w) * q.vec();
  const double half_angle = w < 0 ? std::atan2(-n, -w) : std::atan2(n, w);
  return (2.0 * half_angle / n) * q.vec();
}

// Rotation vector nearest to `near` among phi + 2 pi k axis, k integer.
inline Eigen::Vector3d LogNear(const Eigen::Quaterniond& q, const Eigen::Vector3d& near) {
  const Eigen::Vector3d phi = Log(q);
  const double angle = phi.norm();
  const Eigen::Vector3d axis = angle < 1e-9 ? near.normalized() : Eigen::Vector3d(phi / angle);  // of a full turn: any
  const double turns = std::round((near.dot(axis) - angle) / (2 * std::numbers::pi));
  return turns == 0 ? phi : Eigen::Vector3d(phi + 2 * std::numbers::pi * turns * axis);
}

// J_r is singular at |phi| = 2 pi k, k > 0: it is evaluated at this distance from there [rad].
constexpr double kFullTurnOffset = 1e-4;
inline Eigen::Vector3d AwayFromFullTurn(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  if (angle < std::numbers::pi) return phi;
  const double off = std::remainder(angle, 2 * std::numbers::pi);
  if (std::abs(off) >= kFullTurnOffset) return phi;
  return (1 + (std::copysign(kFullTurnOffset, off) - off) / angle) * phi;
}

// J_r: Exp(phi + d) = Exp(phi) Exp(J_r(phi) d) to first order in d.
inline Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& at) {
  const Eigen::Vector3d phi = AwayFromFullTurn(at);
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  const double a = t < 1e-3 ? 0.5 - t2 / 24.0 : (1.0 - std::cos(t)) / t2;
  const double b = t < 1e-3 ? 1.0 / 6.0 - t2 / 120.0 : (t - std::sin(t)) / (t2 * t);
  const Eigen::Matrix3d K = Hat(phi);
  return Eigen::Matrix3d::Identity() - a * K + b * K * K;
}

inline Eigen::Matrix3d InverseRightJacobian(const Eigen::Vector3d& at) {
  const Eigen::Vector3d phi = AwayFromFullTurn(at);
  const double t2 = phi.squaredNorm();
  const double t = std::sqrt(t2);
  const double b = t < 1e-3 ? 1.0 / 12.0 + t2 / 720.0 : 1.0 / t2 - (1.0 + std::cos(t)) / (2.0 * t * std::sin(t));
  const Eigen::Matrix3d K = Hat(phi);
  return Eigen::Matrix3d::Identity() + 0.5 * K + b * K * K;
}

// log det J_r(phi): change of volume under Exp.
inline double LogVolume(const Eigen::Vector3d& phi) {
  const double t2 = AwayFromFullTurn(phi).squaredNorm();
  return t2 < 1e-6 ? -t2 / 12.0 : std::log(2.0 * (1.0 - std::cos(std::sqrt(t2))) / t2);
}

}  // namespace vo
