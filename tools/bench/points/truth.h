// Ground truth of a run, for evaluation only.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/motion/trajectory.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

struct Truth {
  evaluation::Trajectory poses;
  std::optional<evaluation::Velocities> velocities;
};

// Adds the truth of a frame.
inline void Append(std::int64_t stamp_ns, const sim::Truth& of_frame, Truth& truth) {
  const auto vector = [](const glm::dvec3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  const glm::dquat& q = of_frame.q_WC;
  truth.poses.push_back({stamp_ns, vector(of_frame.p_WC), {q.w, q.x, q.y, q.z}});
  if (!truth.velocities) truth.velocities.emplace();
  truth.velocities->push_back({stamp_ns, vector(of_frame.v_WC), vector(of_frame.w_WC_C)});
}

}  // namespace vobench
