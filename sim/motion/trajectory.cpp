#include "sim/motion/trajectory.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "sim/motion/path.h"
#include "sim/motion/recorded.h"
#include "sim/motion/sampled.h"
#include "sim/motion/spline.h"

namespace sim {

std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s) {
  if (const auto* sampled = std::get_if<SampledMotion>(&motion)) {
    return std::make_unique<SampledTrajectory>(*sampled, seed, last_stamp_s + margin_s);
  }
  if (const auto* path = std::get_if<PathMotion>(&motion)) return std::make_unique<PathTrajectory>(*path);
  if (const auto* recorded = std::get_if<RecordedMotion>(&motion))
    return MakeRecordedTrajectory(*recorded, last_stamp_s);
  auto trajectory = std::make_unique<SplineTrajectory>(std::get<ScriptedMotion>(motion).keys);
  if (trajectory->end_s() < last_stamp_s) {
    throw std::invalid_argument("the last key pose is at " + std::to_string(trajectory->end_s()) +
                                " s, before the last frame at " + std::to_string(last_stamp_s) + " s");
  }
  return trajectory;
}

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
