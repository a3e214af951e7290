// Checks that hold for every trajectory.
#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "sim/motion/so3.h"
#include "sim/motion/trajectory.h"

namespace sim {

// Numerical derivatives (fourth order, step h) of position, orientation, velocity and angular rate minus the
// trajectory's own.
struct RateErrors {
  double v = 0, w = 0, a = 0, alpha = 0;
};

inline RateErrors RateErrorsAt(const Trajectory& trajectory, double t, double h) {
  const Motion at = trajectory.At(t);
  const auto p = [&](double s) { return trajectory.At(t + s).pose.p_WC; };
  const auto phi = [&](double s) { return Log(glm::conjugate(at.pose.q_WC) * trajectory.At(t + s).pose.q_WC); };
  const auto slope = [h](auto&& f) { return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h); };
  const auto v = [&](double s) { return trajectory.At(t + s).v_WC; };
  const auto w = [&](double s) { return trajectory.At(t + s).w_WC_C; };
  return {glm::length(slope(p) - at.v_WC), glm::length(slope(phi) - at.w_WC_C), glm::length(slope(v) - at.a_WC),
          glm::length(slope(w) - at.alpha_WC_C)};
}

}  // namespace sim
