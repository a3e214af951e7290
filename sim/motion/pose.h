// Rigid pose: T_WC of the camera (docs/conventions.md), or T_WO of a moving object by the same names.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace sim {

// X_W = R(q_WC) X_C + p_WC. glm::dquat's constructor takes (w, x, y, z).
struct Pose {
  glm::dvec3 p_WC{0.0};                 // [m]
  glm::dquat q_WC{1.0, 0.0, 0.0, 0.0};  // unit
};

// Viewpoint: pose and time. The time matters only where objects move.
struct View {
  View(const Pose& from = {}, double at_s = 0.0) : pose(from), t_s(at_s) {}
  Pose pose;
  double t_s;  // [s]
};

}  // namespace sim
