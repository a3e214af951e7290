#include <algorithm>
#include <cmath>

#include "tools/base/text.h"
#include "tools/judge/verification/comparisons.h"
#include "vo/geometry/so3.h"

namespace verification {
namespace {

using Eigen::Vector3d;

constexpr double kText = 2e-11;  // rounding of the texts' twelve decimals, and of the products here

enum Row { kPoses, kOffsets, kDepth, kDisparity, kHidden, kBody };

void ComparePoses(const Sequence& body, const RigCamera& camera, const Sequence& s, Check& check) {
  for (std::size_t k = 0; k < s.stamps.size(); ++k) {
    const auto at = std::ranges::lower_bound(body.stamps, s.stamps[k]);
    const std::string where = camera.name + "/groundtruth.txt " + base::FormatSeconds(s.stamps[k]);
    if (at == body.stamps.end() || *at != s.stamps[k]) {
      check.Fail(where + ": the body has no pose at this time");
      continue;
    }
    if (!s.has_pose[k]) continue;
    const vo::Pose &T_WB = body.poses[static_cast<std::size_t>(at - body.stamps.begin())], &T_WC = s.poses[k];
    const Vector3d p = T_WB.p_WC + T_WB.q_WC * camera.T_BC.p_WC;
    const double turn = vo::Log(T_WC.q_WC.conjugate() * T_WB.q_WC * camera.T_BC.q_WC).norm();
    check.Add(std::max((p - T_WC.p_WC).norm(), turn), kText, where);
  }
}

// Static surfaces seen by both cameras must coincide.
void CompareDepths(Part& a, Part& b, std::size_t k, const std::string& where, Check& check) {
  if (!a.sequence.has_pose[k] || !b.sequence.has_pose[k]) return;
  const cv::Mat moving = a.frames.Picture("moving", k);
  if (!a.sequence.objects.empty() && moving.empty()) return;
  const Relative move = Between(a.sequence.poses[k], b.sequence.poses[k]);
  std::vector<double> ratios;
  MatchDepths(
      a.frames, k, b.frames, k,
      [&](std::size_t i) { return std::span(&move, moving.empty() || moving.data[i] == 0 ? 1 : 0); },
      [&](std::size_t, double ratio) { ratios.push_back(ratio); });
  if (ratios.size() < 100) return;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  check.Add(*middle, 1, where);
}

void CompareDisparity(Part& a, Part& b, const std::vector<RigCamera>& rig, std::size_t k, std::vector<Check>& checks) {
  const cv::Mat disparity = a.frames.Picture("disparity", k), depth = a.frames.Depth(k);
  if (disparity.empty() || depth.empty()) return;
  const Relative move = Between(rig[0].T_BC, rig[1].T_BC);
  const double fb = -a.sequence.camera.fx * move.t.x();
  LargestRatio worst;
  for (std::size_t i = 0; i < depth.total(); ++i) {
    const double Z = static_cast<double>(reinterpret_cast<const float*>(depth.data)[i]),
                 d = static_cast<double>(reinterpret_cast<const float*>(disparity.data)[i]);
    if (Z > 0) worst.Add(std::abs(d - fb / Z), 1.1 * fb / (Z * Z) * a.frames.DepthError(Z) + 2e-6 + 1e-6 * fb / Z);
  }
  checks[kDisparity].Add(worst, "disparity " + a.frames.Stamp(k));
  CompareHidden(
      a.frames, k, "disparity_occlusion", b.frames, k, [&](std::size_t) { return std::span(&move, 1); },
      checks[kHidden]);
}

}  // namespace

Part::Part(const std::filesystem::path& folder, const std::filesystem::path& manifest, double arm_m)
    : sequence(ReadSequence(folder, manifest, files, stamps)), frames(sequence, files) {
  sequence.roughness.position = std::hypot(sequence.roughness.position, arm_m * sequence.roughness.orientation);
}

std::vector<Check> CheckRig(const std::filesystem::path& folder, const std::vector<RigCamera>& rig,
                            const std::vector<std::unique_ptr<Part>>& parts) {
  std::vector<Check> checks = {
      {"cameras' poses against the body's", "m, rad"},   {"stamps less the trigger offsets", "s"},
      {"depth in the first camera: median", "of bound"}, {"disparity against depth and the base", "px"},
      {"disparity_occlusion against depth: share", ""},  {"files of the body", ""}};
  const Sequence body = ReadBody(folder, checks[kBody]);
  for (std::size_t c = 0; c < parts.size(); ++c) ComparePoses(body, rig[c], parts[c]->sequence, checks[kPoses]);
  for (std::size_t c = 1; c < parts.size(); ++c) {
    Part &first = *parts[0], &other = *parts[c];
    const std::size_t count = first.sequence.stamps.size();
    if (other.sequence.stamps.size() != count) {
      checks[kOffsets].Fail(rig[c].name + " has not as many frames as " + rig[0].name);
      continue;
    }
    const double offset_s = rig[c].trigger_offset_s - rig[0].trigger_offset_s;
    for (std::size_t k = 0; k < count; ++k) {
      const std::string where = rig[c].name + " " + other.frames.Stamp(k);
      const double later_s = static_cast<double>(other.sequence.stamps[k] - first.sequence.stamps[k]) * 1e-9;
      checks[kOffsets].Add(std::abs(later_s - offset_s), 2.5e-9, where);
      CompareDepths(other, first, k, where, checks[kDepth]);
      if (c == 1) CompareDisparity(first, other, rig, k, checks);
    }
  }
  for (Check& check : CheckMotion(body)) {
    check.Prefix("body");
    checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace verification
