#include "tools/judge/evaluation/compat/openvins.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation::compat {
namespace {

constexpr double kGap_s = 0.02;
constexpr double kSegmentTolerance_m = 0.5;

// Rotation by the tool's own formula, which for a quaternion of inexact norm is not exactly a rotation.
Eigen::Matrix3d Rotation(const Eigen::Quaterniond& q) {
  Eigen::Matrix3d cross;
  cross << 0, -q.z(), q.y(), q.z(), 0, -q.x(), -q.y(), q.x(), 0;
  return (2 * q.w() * q.w() - 1) * Eigen::Matrix3d::Identity() + 2 * q.w() * cross + 2 * q.vec() * q.vec().transpose();
}

double AngleOf(const Eigen::Matrix3d& R) {
  const double trace = R.trace();
  const Eigen::Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  if (trace + 1 < 1e-10) return M_PI;
  const double theta = trace - 3 < -1e-7 ? std::acos((trace - 1) / 2) : 0;
  return (theta > 0 ? theta / (2 * std::sin(theta)) : 0.5 - (trace - 3) / 12) * twice_sine.norm();
}

struct Pose {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};

// Forward through both lists: each pose of the estimate takes the nearest true pose not before that of an earlier one.
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

Similarity AlignmentOf(const MatchedTrajectories& matched, OvAlignment alignment) {
  if (alignment == OvAlignment::none) return {};
  if (alignment == OvAlignment::se3) return Align(matched, Alignment::se3);
  if (alignment == OvAlignment::sim3) return Align(matched, Alignment::sim3);
  if (alignment == OvAlignment::posyaw) return Align(matched, Alignment::yaw);
  const Eigen::Matrix3d estimate = Rotation(matched.estimate[0].q_WC), truth = Rotation(matched.truth[0].q_WC);
  Similarity first;
  first.R = alignment == OvAlignment::posyawsingle ? BestYaw(estimate * truth.transpose())
                                                   : Eigen::Matrix3d(truth * estimate.transpose());
  first.t = matched.truth[0].p_WC - first.R * matched.estimate[0].p_WC;
  return first;
}

Statistics Summarised(const std::vector<double>& values) {
  Statistics s = Summarise(values);
  const double n = static_cast<double>(values.size());
  if (values.size() > 1) s.std *= std::sqrt(n / (n - 1));
  return s;
}

void AddSegment(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, const std::vector<double>& way,
                double length_m, std::vector<NamedStatistics>& errors) {
  std::vector<double> ori, pos;
  for (const auto& [i, j] : PairsByLength(way, length_m, kSegmentTolerance_m)) {
    const auto motion = [](const Pose& from, const Pose& to) {
      return Pose{from.R.transpose() * to.R, from.R.transpose() * (to.p - from.p)};
    };
    const Pose A = motion(estimate[i], estimate[j]), B = motion(truth[i], truth[j]);
    const Eigen::Matrix3d& world = estimate[j].R;
    ori.push_back(kDegrees * AngleOf(world * B.R.transpose() * A.R * world.transpose()));
    pos.push_back((world * (B.R.transpose() * (A.p - B.p))).norm());
  }
  const std::string over = Fixed(length_m, 2) + "m_";
  errors.push_back({over + "ori", Summarised(ori), "deg"});
  errors.push_back({over + "pos", Summarised(pos), "m"});
}

}  // namespace

std::vector<NamedStatistics> ComputeOv(const Trajectory& estimate, const Trajectory& truth, OvAlignment alignment,
                                       std::vector<double> segments_m) {
  const MatchedTrajectories matched = Associate(estimate, truth);
  const Similarity similarity = AlignmentOf(matched, alignment);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(similarity.R).normalized();
  std::vector<Pose> aligned, exact;
  std::vector<double> ori, pos;
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const StampedPose& pose = matched.estimate[i];
    aligned.push_back(
        {Rotation((turn * pose.q_WC).normalized()), similarity.scale * similarity.R * pose.p_WC + similarity.t});
    exact.push_back({Rotation(matched.truth[i].q_WC), matched.truth[i].p_WC});
    ori.push_back(kDegrees * AngleOf(aligned[i].R.transpose() * exact[i].R));
    pos.push_back((exact[i].p - aligned[i].p).norm());
  }
  std::vector<NamedStatistics> errors = {{"ori", Summarised(ori), "deg"}, {"pos", Summarised(pos), "m"}};
  std::sort(segments_m.begin(), segments_m.end());
  const std::vector<double> way = CumulativePathLength(matched.truth);
  for (const double length : segments_m) AddSegment(aligned, exact, way, length, errors);
  return errors;
}

}  // namespace evaluation::compat
