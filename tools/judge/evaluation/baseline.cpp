#include "tools/judge/evaluation/baseline.h"

#include "tools/judge/evaluation/so3.h"

namespace evaluation {

Trajectory ConstantPose(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start) {
  Trajectory trajectory;
  for (const std::int64_t stamp : stamps_ns) trajectory.push_back({stamp, start.p_WC, start.q_WC});
  return trajectory;
}

Trajectory ConstantVelocity(const std::vector<std::int64_t>& stamps_ns, const StampedPose& start,
                            const StampedVelocity& velocity) {
  Trajectory trajectory;
  for (const std::int64_t stamp : stamps_ns) {
    const double dt = static_cast<double>(stamp - start.stamp_ns) * 1e-9;
    trajectory.push_back({stamp, start.p_WC + velocity.v_WC * dt, start.q_WC * Exp(velocity.w_WC_C * dt)});
  }
  return trajectory;
}

StampedVelocity StartVelocity(const Trajectory& trajectory) {
  StampedVelocity velocity;
  if (trajectory.empty()) return velocity;
  const StampedPose& first = trajectory.front();
  velocity.stamp_ns = first.stamp_ns;
  std::size_t i = 0;
  while (i + 1 < trajectory.size() && trajectory[i].stamp_ns - first.stamp_ns < 100'000'000) ++i;
  if (i == 0) return velocity;
  const double dt = static_cast<double>(trajectory[i].stamp_ns - first.stamp_ns) * 1e-9;
  velocity.v_WC = (trajectory[i].p_WC - first.p_WC) / dt;
  velocity.w_WC_C = Log(first.q_WC.conjugate() * trajectory[i].q_WC) / dt;
  return velocity;
}

}  // namespace evaluation
