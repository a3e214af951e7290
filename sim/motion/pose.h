// Purpose: where the camera is: T_WC of docs/conventions.md.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace sim {

// X_W = R(q_WC) X_C + p_WC. glm::dquat's constructor takes (w, x, y, z).
struct Pose {
  glm::dvec3 p_WC{0.0};                 // [m]
  glm::dquat q_WC{1.0, 0.0, 0.0, 0.0};  // unit
};

}  // namespace sim
