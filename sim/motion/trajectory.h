// Trajectory: pose, velocity and acceleration as functions of time, in closed form.
#pragma once

#include <glm/vec3.hpp>

#include "sim/motion/pose.h"

namespace sim {

struct Motion {
  Pose pose;
  glm::dvec3 v_WC{0.0};        // of the camera centre, in W [m/s]: the exact derivative of pose.p_WC
  glm::dvec3 w_WC_C{0.0};      // of C against W, in C [rad/s]: q(t + dt) = q(t) * Exp(w dt) to first order
  glm::dvec3 a_WC{0.0};        // in W [m/s^2]: the exact derivative of v_WC
  glm::dvec3 alpha_WC_C{0.0};  // in C [rad/s^2]: the exact derivative of w_WC_C by components
};

// Time is in seconds; 0 is the stamp of the first frame. It is extrapolated at constant velocity before 0 and after
// end_s(), by half an exposure at least. Where an acceleration jumps (a sampled motion at its knots), it is the
// right-hand limit.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual Motion At(double t_s) const = 0;
  virtual double end_s() const = 0;
};

}  // namespace sim
