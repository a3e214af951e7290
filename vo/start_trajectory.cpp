#include "vo/start_trajectory.h"

namespace vo {
namespace {

Pose Between(const Pose& a, const Pose& b, double share) {
  return {a.p_WC + share * (b.p_WC - a.p_WC), a.q_WC.slerp(share, b.q_WC)};
}

}  // namespace

void StartTrajectory::Add(std::int64_t stamp_ns, const FilterAnswer& answer, const ScaleAmbiguity& scale) {
  reissued_.clear();
  if (over_) return;
  stamps_ns_.push_back(stamp_ns);
  if (answer.initialising) return;
  over_ = true;
  for (std::size_t i = 0; i < answer.start.size(); ++i) {
    const auto& [frame, pose] = answer.start[i];
    for (std::size_t between = reissued_.size(); between < frame; ++between) {
      const StartPose& before = answer.start[i - 1];
      const double since = static_cast<double>(stamps_ns_[between] - stamps_ns_[before.frame]);
      const double all = static_cast<double>(stamps_ns_[frame] - stamps_ns_[before.frame]);
      reissued_.push_back({stamps_ns_[between], scale.ToAnswer(Between(before.pose, pose, since / all))});
    }
    reissued_.push_back({stamps_ns_[frame], scale.ToAnswer(pose)});
  }
  stamps_ns_ = {};
}

}  // namespace vo
