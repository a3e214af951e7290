#include "sim/motion/trajectory.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "sim/motion/path.h"
#include "sim/motion/recorded.h"
#include "sim/motion/roaming.h"
#include "sim/motion/sampled.h"
#include "sim/motion/spline.h"

namespace sim {

std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s, const Surroundings* around) {
  const double end_s = last_stamp_s + margin_s;
  const auto with = [&](const std::optional<CarrierMotionParams>& shake, std::unique_ptr<Trajectory> path) {
    return shake ? Shaken(*path, *shake, seed, end_s) : std::move(path);
  };
  if (const auto* sampled = std::get_if<SampledMotion>(&motion))
    return std::make_unique<SampledTrajectory>(*sampled, seed, end_s);
  if (const auto* path = std::get_if<PathMotion>(&motion))
    return with(path->shake, std::make_unique<PathTrajectory>(*path));
  if (const auto* recorded = std::get_if<RecordedMotion>(&motion))
    return MakeRecordedTrajectory(*recorded, last_stamp_s, seed, around);
  if (const auto* roaming = std::get_if<RoamingMotion>(&motion)) return MakeRoaming(*roaming, seed, end_s, around);
  const auto& scripted = std::get<ScriptedMotion>(motion);
  auto trajectory = std::make_unique<SplineTrajectory>(scripted.keys);
  if (trajectory->end_s() >= last_stamp_s) return with(scripted.shake, std::move(trajectory));
  throw std::invalid_argument("the last key pose is at " + std::to_string(trajectory->end_s()) +
                              " s, before the last frame at " + std::to_string(last_stamp_s) + " s");
}

bool NeedsSurroundings(const MotionDescription& motion) {
  const auto* recorded = std::get_if<RecordedMotion>(&motion);
  return std::holds_alternative<RoamingMotion>(motion) ||
         (recorded != nullptr && recorded->placing == RecordedMotion::Placing::automatic);
}

std::shared_ptr<const Trajectory> Mounted(std::shared_ptr<const Trajectory> body, const Pose& T_BC) {
  struct OnBody : Trajectory {
    std::shared_ptr<const Trajectory> body;
    Pose T_BC;
    Motion At(double t_s) const override {
      const Motion b = body->At(t_s);
      const glm::dvec3 &r = T_BC.p_WC, &w = b.w_WC_C;
      const glm::dquat &q_WB = b.pose.q_WC, q_CB = glm::conjugate(T_BC.q_WC);
      const glm::dvec3 a_B = glm::cross(b.alpha_WC_C, r) + glm::cross(w, glm::cross(w, r));
      return {{b.pose.p_WC + q_WB * r, q_WB * T_BC.q_WC},
              b.v_WC + q_WB * glm::cross(w, r),
              q_CB * w,
              b.a_WC + q_WB * a_B,
              q_CB * b.alpha_WC_C};
    }
  };
  auto mounted = std::make_shared<OnBody>();
  mounted->body = std::move(body);
  mounted->T_BC = T_BC;
  return mounted;
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
