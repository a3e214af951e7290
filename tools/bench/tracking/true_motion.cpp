#include "tools/bench/tracking/true_motion.h"

#include <algorithm>

#include "tools/judge/evaluation/so3.h"

namespace vobench {
namespace {

constexpr std::int64_t kLongestGap_ns = 250'000'000;

// Value at s in [0, 1] of the cubic from 0 to `end` whose derivatives with respect to s are d0 and d1.
Eigen::Vector3d Hermite(double s, const Eigen::Vector3d& end, const Eigen::Vector3d& d0, const Eigen::Vector3d& d1) {
  const double r = 1 - s;
  return s * s * (3 - 2 * s) * end + s * r * r * d0 - s * s * r * d1;
}

}  // namespace

std::optional<vo::Pose> TrueMotion::At(std::int64_t stamp_ns) const {
  const evaluation::Trajectory& poses = truth_.poses;
  if (poses.size() < 2) return std::nullopt;
  const auto after = std::ranges::upper_bound(poses, stamp_ns, {}, &evaluation::StampedPose::stamp_ns);
  const auto next = std::clamp(after, poses.begin() + 1, poses.end() - 1);
  const evaluation::StampedPose &a = *(next - 1), &b = *next;
  const std::int64_t gap_ns = b.stamp_ns - a.stamp_ns;
  if (gap_ns > kLongestGap_ns || stamp_ns - b.stamp_ns > kLongestGap_ns / 2 ||
      a.stamp_ns - stamp_ns > kLongestGap_ns / 2) {
    return std::nullopt;
  }
  const double s = static_cast<double>(stamp_ns - a.stamp_ns) / static_cast<double>(gap_ns);
  const Eigen::Vector3d move = b.p_WC - a.p_WC, turn = evaluation::Log(a.q_WC.conjugate() * b.q_WC);
  const auto velocity = [&](std::int64_t at_ns) {
    return truth_.velocities ? evaluation::VelocityAt(*truth_.velocities, at_ns) : std::nullopt;
  };
  const auto v0 = velocity(a.stamp_ns), v1 = velocity(b.stamp_ns);
  if (!v0 || !v1) return vo::Pose{a.p_WC + s * move, a.q_WC * evaluation::Exp(s * turn)};
  if (s < 0 || s > 1) {
    const evaluation::StampedPose& end = s < 0 ? a : b;
    const evaluation::StampedVelocity& rate = s < 0 ? *v0 : *v1;
    const double since_s = 1e-9 * static_cast<double>(stamp_ns - end.stamp_ns);
    return vo::Pose{end.p_WC + since_s * rate.v_WC, end.q_WC * evaluation::Exp(since_s * rate.w_WC_C)};
  }
  // d(phi)/dt of Exp(phi) = q_a^-1 q is J_r(phi)^-1 w; w up to the second order in the turn.
  const double dt = 1e-9 * static_cast<double>(gap_ns);
  const Eigen::Vector3d &w0 = v0->w_WC_C, &w1 = v1->w_WC_C;
  const Eigen::Vector3d end_rate = w1 + 0.5 * turn.cross(w1) + turn.cross(turn.cross(w1)) / 12;
  return vo::Pose{a.p_WC + Hermite(s, move, dt * v0->v_WC, dt * v1->v_WC),
                  a.q_WC * evaluation::Exp(Hermite(s, turn, dt * w0, dt * end_rate))};
}

}  // namespace vobench
