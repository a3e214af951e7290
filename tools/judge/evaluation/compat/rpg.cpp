#include "tools/judge/evaluation/compat/rpg.h"

#include <algorithm>
#include <cmath>

#include "tools/judge/evaluation/compat/subtrajectory.h"
#include "tools/judge/evaluation/so3.h"

namespace evaluation::compat {
namespace {

Similarity AlignmentOf(const MatchedTrajectories& matched, RpgAlignment alignment) {
  switch (alignment) {
    case RpgAlignment::sim3:
      return Align(matched, Alignment::sim3);
    case RpgAlignment::se3:
      return Align(matched, Alignment::se3);
    case RpgAlignment::posyaw:
      return AlignYaw(matched);
    case RpgAlignment::none:
      break;
  }
  return {};
}

// A tenth, two, ... five tenths, cut to centimetres.
std::vector<double> Lengths(double way_m) {
  std::vector<double> lengths;
  for (const double part : {0.1, 0.2, 0.3, 0.4, 0.5}) lengths.push_back(std::trunc(part * way_m * 100) / 100);
  return lengths;
}

// E = B^-1 A seen in the world of the estimate: rotated by the estimate's orientation at the end of the pair.
RpgRelativeErrors Relative(const MatchedTrajectories& matched, double length_m, double scale) {
  std::vector<double> trans, trans_perc, rot, rot_per_m, yaw, gravity;
  const double tolerance_m = 0.2 * length_m;
  for (const auto& [i, j] : PairsByLength(CumulativePathLength(matched.truth), length_m, tolerance_m)) {
    const StampedPose &a = matched.estimate[i], &b = matched.estimate[j];
    const StampedPose &c = matched.truth[i], &d = matched.truth[j];
    const Eigen::Quaterniond A = a.q_WC.conjugate() * b.q_WC, B = c.q_WC.conjugate() * d.q_WC;
    const Eigen::Vector3d t = scale * (a.q_WC.conjugate() * (b.p_WC - a.p_WC)) - c.q_WC.conjugate() * (d.p_WC - c.p_WC);
    const Eigen::Quaterniond E = B.conjugate() * A;
    const Eigen::Matrix3d R = (b.q_WC * E * b.q_WC.conjugate()).toRotationMatrix();
    trans.push_back(t.norm());
    trans_perc.push_back(t.norm() / length_m * 100);
    rot.push_back(Log(E).norm() * kDegrees);
    rot_per_m.push_back(rot.back() / length_m);
    // R = Rz(yaw) Ry(pitch) Rx(roll).
    yaw.push_back(std::abs(std::atan2(R(1, 0), R(0, 0))) * kDegrees);
    const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), roll = std::atan2(R(2, 1), R(2, 2));
    gravity.push_back(std::hypot(pitch, roll) * kDegrees);
  }
  return {length_m,       Summarise(trans),  Summarise(trans_perc), Summarise(rot), Summarise(rot_per_m),
          Summarise(yaw), Summarise(gravity)};
}

}  // namespace

RpgResult ComputeRpg(const Trajectory& estimate, const Trajectory& truth, RpgAlignment alignment,
                     std::vector<double> lengths_m) {
  const MatchedTrajectories matched = MatchTrajectories(estimate, truth, {.rule = AssociationRule::tum});
  RpgResult result;
  result.similarity = AlignmentOf(matched, alignment);
  std::vector<double> trans, rot;
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const StampedPose aligned = Apply(result.similarity, matched.estimate[i]);
    trans.push_back((matched.truth[i].p_WC - aligned.p_WC).norm());
    rot.push_back(AngleBetween(matched.truth[i].q_WC, aligned.q_WC) * kDegrees);
  }
  result.trans = Summarise(trans);
  result.rot = Summarise(rot);
  if (lengths_m.empty()) lengths_m = Lengths(PathLength(matched.truth));
  for (const double length : lengths_m) {
    if (!(length > 0)) continue;
    RpgRelativeErrors errors = Relative(matched, length, result.similarity.scale);
    if (errors.trans.count >= 2) result.relative.push_back(errors);
  }
  return result;
}

std::vector<NamedValue> Values(const RpgResult& result) {
  std::vector<NamedValue> values;
  Append("trans", result.trans, "m", values);
  Append("rot", result.rot, "deg", values);
  for (const RpgRelativeErrors& errors : result.relative) {
    const std::string over = Fixed(errors.length_m, 2) + "m_";
    Append(over + "trans", errors.trans, "m", values);
    Append(over + "trans_perc", errors.trans_perc, "%", values);
    Append(over + "rot", errors.rot, "deg", values);
    Append(over + "rot_deg_per_m", errors.rot_deg_per_m, "deg/m", values);
    Append(over + "yaw", errors.yaw, "deg", values);
    Append(over + "gravity", errors.gravity, "deg", values);
  }
  return values;
}

}  // namespace evaluation::compat
