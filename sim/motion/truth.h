// Ground truth of a frame: pose, velocity, acceleration.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "sim/motion/trajectory.h"

namespace sim {

// At the stamp; conventions as in docs/conventions.md.
struct Truth {
  glm::dvec3 p_WC{0.0};                 // [m]
  glm::dquat q_WC{1.0, 0.0, 0.0, 0.0};  // unit, w >= 0
  glm::dvec3 v_WC{0.0};                 // in W [m/s]
  glm::dvec3 w_WC_C{0.0};               // in C [rad/s]
  glm::dvec3 a_WC{0.0};                 // in W [m/s^2]; exact derivatives, as sim/motion/trajectory.h says
  glm::dvec3 alpha_WC_C{0.0};           // in C [rad/s^2]
};

// Throws std::logic_error when the motion is not finite or not a rotation: our bug.
Truth TruthAt(const Trajectory& trajectory, double t_s);

}  // namespace sim
