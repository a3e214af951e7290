// Purpose: the exponential of rotations, its logarithm and right Jacobian (Forster et al. 2017, "On-manifold
//          preintegration", equations 3-10). Rotation vectors in radians.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace sim {

inline glm::dquat Exp(const glm::dvec3& phi) {
  const double angle = glm::length(phi);
  const double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), scale * phi.x, scale * phi.y, scale * phi.z};
}

// The shortest rotation vector, length <= pi.
inline glm::dvec3 Log(const glm::dquat& q) {
  const double sign = q.w < 0 ? -1.0 : 1.0;
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);  // of half the angle
  const double w = std::abs(q.w);
  const double scale = sine < 1e-8 ? 2.0 / w : 2.0 * std::atan2(sine, w) / sine;
  return sign * scale * v;
}

// Exp(phi + d) = Exp(phi) * Exp(J_r(phi) d) to first order in d. Returns J_r(phi) d.
inline glm::dvec3 RightJacobianTimes(const glm::dvec3& phi, const glm::dvec3& d) {
  const double a2 = glm::dot(phi, phi), a = std::sqrt(a2);
  const double b = a < 1e-3 ? 0.5 - a2 / 24 : (1 - std::cos(a)) / a2;
  const double c = a < 1e-3 ? 1.0 / 6 - a2 / 120 : (a - std::sin(a)) / (a2 * a);
  const glm::dvec3 cross = glm::cross(phi, d);
  return d - b * cross + c * glm::cross(phi, cross);
}

// Its inverse times d, for angles below pi.
inline glm::dvec3 InverseRightJacobianTimes(const glm::dvec3& phi, const glm::dvec3& d) {
  const double a2 = glm::dot(phi, phi), a = std::sqrt(a2);
  const double c = a < 1e-2 ? 1.0 / 12 + a2 / 720 : 1 / a2 - (1 + std::cos(a)) / (2 * a * std::sin(a));
  const glm::dvec3 cross = glm::cross(phi, d);
  return d + 0.5 * cross + c * glm::cross(phi, cross);
}

}  // namespace sim
