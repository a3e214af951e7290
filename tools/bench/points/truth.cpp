#include "tools/bench/points/truth.h"

namespace vobench {
namespace {

Eigen::Vector3d ToEigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Eigen::Quaterniond ToEigen(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }

}  // namespace

void Append(std::int64_t stamp_ns, const sim::Truth& of_frame, Truth& truth) {
  truth.poses.push_back({stamp_ns, ToEigen(of_frame.p_WC), ToEigen(of_frame.q_WC)});
  if (!truth.velocities) truth.velocities.emplace();
  truth.velocities->push_back({stamp_ns, ToEigen(of_frame.v_WC), ToEigen(of_frame.w_WC_C)});
}

}  // namespace vobench
