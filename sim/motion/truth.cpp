#include "sim/motion/truth.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace sim {

Truth TruthAt(const Trajectory& trajectory, double t_s) {
  const Motion motion = trajectory.At(t_s);
  const glm::dquat q = motion.pose.q_WC.w < 0 ? -motion.pose.q_WC : motion.pose.q_WC;
  const double size = glm::length(motion.pose.p_WC) + glm::length(motion.v_WC) + glm::length(motion.w_WC_C) +
                      glm::length(motion.a_WC) + glm::length(motion.alpha_WC_C);
  if (!std::isfinite(size) || !(std::abs(glm::length(q) - 1) < 1e-9)) {
    throw std::logic_error("the truth at " + std::to_string(t_s) + " s is not finite or not a rotation");
  }
  return {motion.pose.p_WC, q, motion.v_WC, motion.w_WC_C, motion.a_WC, motion.alpha_WC_C};
}

}  // namespace sim
