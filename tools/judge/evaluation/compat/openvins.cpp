#include "tools/judge/evaluation/compat/openvins.h"

#include <cmath>
#include <cstdlib>

#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation::compat {
namespace {

constexpr double kGap_s = 0.02;

// Forward through both lists: each pose of the estimate takes the nearest true pose that no earlier one went past.
MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& truth) {
  const auto seconds = [](const StampedPose& pose) { return SecondsAsRead(pose.stamp_ns); };
  MatchedTrajectories matched;
  std::size_t next = 0;
  for (const StampedPose& pose : estimate) {
    const double t = seconds(pose);
    while (next < truth.size() && seconds(truth[next]) < t && std::abs(seconds(truth[next]) - t) > kGap_s) ++next;
    const StampedPose* best = nullptr;
    double apart = kGap_s;
    while (next < truth.size() && std::abs(seconds(truth[next]) - t) <= kGap_s) {
      if (std::abs(seconds(truth[next]) - t) >= apart) break;
      best = &truth[next++];
      apart = std::abs(seconds(*best) - t);
    }
    if (best == nullptr) continue;
    matched.estimate.push_back(pose);
    matched.truth.push_back(*best);
  }
  if (matched.estimate.size() < 2) {
    throw InputError({"ov_eval: estimate and truth have less than two poses in common within 0.02 s"});
  }
  return matched;
}

}  // namespace

Statistics ComputeOv(const Trajectory& estimate, const Trajectory& truth, OvAlignment alignment) {
  const MatchedTrajectories matched = Associate(estimate, truth);
  Similarity similarity;
  if (alignment == OvAlignment::posyaw) similarity = AlignYaw(matched);
  if (alignment == OvAlignment::se3) similarity = Align(matched, Alignment::se3);
  if (alignment == OvAlignment::sim3) similarity = Align(matched, Alignment::sim3);
  Statistics s = Summarise(ErrorsAfter(similarity, matched).position);
  const auto n = static_cast<double>(s.count);
  s.std *= std::sqrt(n / (n - 1));
  return s;
}

std::string PrintOv(const Statistics& position) {
  std::string text;
  for (const auto& [part, value] : Parts(position)) {
    text += "pos_" + part + " = " + base::Significant(value, 12) + " m\n";
  }
  return text + "pos_samples = " + std::to_string(position.count) + " 1\n";
}

}  // namespace evaluation::compat
