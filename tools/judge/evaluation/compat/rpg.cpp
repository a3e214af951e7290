#include "tools/judge/evaluation/compat/rpg.h"

#include <cmath>

#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation::compat {
namespace {

std::vector<double> Times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

// E = B^-1 A seen in the world of the estimate: rotated by the estimate's orientation at the end of the pair.
std::vector<NamedStatistics> Relative(const MatchedTrajectories& matched, double length_m, double scale) {
  const double tolerance_m = 0.2 * length_m;
  const Rpe rpe = ComputeRpe(matched, PairsByLength(CumulativePathLength(matched.truth), length_m, tolerance_m), scale);
  std::vector<double> trans_perc, rot_per_m, yaw, gravity;
  const std::vector<double> rot = Times(rpe.orientation, kDegrees);
  for (std::size_t k = 0; k < rpe.pairs.size(); ++k) {
    const auto& [i, j] = rpe.pairs[k];
    const Eigen::Quaterniond &end = matched.estimate[j].q_WC, A = matched.estimate[i].q_WC.conjugate() * end,
                             B = matched.truth[i].q_WC.conjugate() * matched.truth[j].q_WC;
    const Eigen::Matrix3d R = (end * (B.conjugate() * A) * end.conjugate()).toRotationMatrix();
    trans_perc.push_back(rpe.position[k] / length_m * 100);
    rot_per_m.push_back(rot[k] / length_m);
    // R = Rz(yaw) Ry(pitch) Rx(roll).
    yaw.push_back(std::abs(std::atan2(R(1, 0), R(0, 0))) * kDegrees);
    const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), roll = std::atan2(R(2, 1), R(2, 2));
    gravity.push_back(std::hypot(pitch, roll) * kDegrees);
  }
  const std::string over = Fixed(length_m, 2) + "m_";
  return {{over + "trans", rpe.position_statistics, "m"}, {over + "trans_perc", Summarise(trans_perc), "%"},
          {over + "rot", Summarise(rot), "deg"},          {over + "rot_deg_per_m", Summarise(rot_per_m), "deg/m"},
          {over + "yaw", Summarise(yaw), "deg"},          {over + "gravity", Summarise(gravity), "deg"}};
}

}  // namespace

RpgResult ComputeRpg(const Trajectory& estimate, const Trajectory& truth, Alignment alignment,
                     std::vector<double> lengths_m) {
  const MatchedTrajectories matched = MatchTrajectories(estimate, truth, {.rule = AssociationRule::tum});
  if (matched.estimate.size() < 3 && alignment != Alignment::none)
    throw InputError({"rpg: fewer than three pairs of poses determine no alignment"});
  RpgResult result;
  result.similarity = Align(matched, alignment);
  const PoseErrors absolute = ErrorsAfter(result.similarity, matched);
  result.errors = {{"trans", Summarise(absolute.position), "m"},
                   {"rot", Summarise(Times(absolute.orientation, kDegrees)), "deg"}};
  if (lengths_m.empty()) {  // a tenth, two, ... five tenths, cut to centimetres
    const double way_m = PathLength(matched.truth);
    for (const double part : {0.1, 0.2, 0.3, 0.4, 0.5}) lengths_m.push_back(std::trunc(part * way_m * 100) / 100);
  }
  for (const double length : lengths_m) {
    if (!(length > 0)) continue;
    const std::vector<NamedStatistics> errors = Relative(matched, length, result.similarity.scale);
    if (errors.front().statistics.count >= 2) result.errors.insert(result.errors.end(), errors.begin(), errors.end());
  }
  return result;
}

}  // namespace evaluation::compat
