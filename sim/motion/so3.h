// Exponential map, logarithm and right Jacobian of SO(3). Rotation vectors in radians.
// Source: Forster et al. 2017, "On-manifold preintegration", equations 3-10.
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

// The derivative of J_r(phi(t)) d by t at constant d, for phi' = rate. With J_r d = d - b phi x d + c phi x (phi x d)
// and b' = (phi . rate) db, c' = (phi . rate) dc.
inline glm::dvec3 RightJacobianRateTimes(const glm::dvec3& phi, const glm::dvec3& rate, const glm::dvec3& d) {
  const double a2 = glm::dot(phi, phi), a = std::sqrt(a2);
  double b = 0.5, c = 1.0 / 6, db = 0, dc = 0;
  if (a < 0.1) {  // the next terms are below 1e-16
    c = 1.0 / 6 + a2 * (-1.0 / 120 + a2 * (1.0 / 5040 - a2 / 362880));
    b = 1.0 / 2 + a2 * (-1.0 / 24 + a2 * (1.0 / 720 - a2 / 40320));
    db = -1.0 / 12 + a2 * (1.0 / 180 + a2 * (-1.0 / 6720 + a2 / 453600));
    dc = -1.0 / 60 + a2 * (1.0 / 1260 + a2 * (-1.0 / 60480 + a2 / 4989600));
  } else {
    b = (1 - std::cos(a)) / a2;
    c = (a - std::sin(a)) / (a2 * a);
    db = (std::sin(a) / a - 2 * b) / a2;
    dc = (b - 3 * c) / a2;
  }
  const double slope = glm::dot(phi, rate);
  const glm::dvec3 phi_d = glm::cross(phi, d);
  return -db * slope * phi_d - b * glm::cross(rate, d) + dc * slope * glm::cross(phi, phi_d) +
         c * (glm::cross(rate, phi_d) + glm::cross(phi, glm::cross(rate, d)));
}

// Its inverse times d, for angles below pi.
inline glm::dvec3 InverseRightJacobianTimes(const glm::dvec3& phi, const glm::dvec3& d) {
  const double a2 = glm::dot(phi, phi), a = std::sqrt(a2);
  const double c = a < 1e-2 ? 1.0 / 12 + a2 / 720 : 1 / a2 - (1 + std::cos(a)) / (2 * a * std::sin(a));
  const glm::dvec3 cross = glm::cross(phi, d);
  return d + 0.5 * cross + c * glm::cross(phi, cross);
}

}  // namespace sim
