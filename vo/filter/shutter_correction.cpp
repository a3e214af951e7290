#include "vo/filter/shutter_correction.h"

namespace vo {

std::vector<PoseMotion> MotionsAlong(const Window& window, const Pose& start, const PathGaussian& path) {
  const std::vector<Window::Frame>& frames = window.frames();
  std::vector<Vector6> steps;  // mean velocities
  for (std::size_t k = 0; k < frames.size(); ++k)
    steps.push_back(StepTo(static_cast<int>(k), path, start) / frames[k].dt);
  const std::size_t last = steps.size();
  if (last == 1) return std::vector<PoseMotion>(2, {steps[0], Vector6::Zero()});
  std::vector<PoseMotion> motions(last + 1);
  for (std::size_t k = 1; k < last; ++k) {
    const double before = frames[k - 1].dt, after = frames[k].dt;
    motions[k] = {(after * steps[k - 1] + before * steps[k]) / (before + after),
                  2 * (steps[k] - steps[k - 1]) / (before + after)};
  }
  motions.front() = {2 * steps.front() - motions[1].velocity, motions[1].acceleration};
  motions.back() = {steps.back(), Vector6::Zero()};
  return motions;
}

CorrectedWindow CorrectShutter(const Window& window, const LandmarkTable& table, std::span<const FirstView> first_views,
                               const WindowInput& in, const PathSolution& solution, SlotRange slots,
                               ShutterReference reference, bool rates, const LandmarkParams& params) {
  std::vector<PoseMotion> motions = MotionsAlong(window, in.start, solution.path);
  for (std::size_t k = 0; rates && k < motions.size(); ++k) motions[k].velocity.tail<3>() += solution.path.rates[k];
  std::vector<Pose> anchors(in.anchors.begin(), in.anchors.end());
  window.PlaceAnchors(solution.path, anchors);
  std::vector<std::vector<AnchorView>> views;
  if (reference == ShutterReference::frame_pose)
    for (const Pose& pose : solution.path.mean) views.push_back(ViewsOf(anchors, pose));

  const auto correct = [&](int slot, const Match& seen) {
    if (seen.row.time == 0 || !slots.contains(slot)) return seen;
    Match match = seen;
    const auto [z, centre_offset_W] = match.row.RotationCompensated(motions[slot + 1].MeanVelocity(match.row.time));
    match.z = z;
    match.centre_offset_W = centre_offset_W;
    if (reference == ShutterReference::row_pose) return match;
    return AtStamp(match, views[slot][table.anchor_of(match.landmark)], solution.modes[match.landmark]);
  };
  CorrectedWindow corrected{window.WithMatches(correct, table), {in.landmarks.begin(), in.landmarks.end()}};
  for (std::size_t n = 0; n < first_views.size(); ++n) {
    FirstView view = first_views[n];
    const int anchor = table.anchor_of(static_cast<int>(n)), slot = window.anchor_slot(anchor);
    if (view.row.time == 0 || !slots.contains(slot)) continue;
    const FirstView seen = FirstSeen(view.row, anchors[anchor], motions[slot + 1].MeanVelocity(view.row.time));
    view.ray = seen.ray;
    view.d_ray_d_rho = seen.d_ray_d_rho;
    if (reference == ShutterReference::frame_pose) {
      view.ray += solution.modes[n].z() * seen.d_ray_d_rho;
      view.d_ray_d_rho.setZero();
    }
    corrected.landmarks[n] = NewLandmark(view, params);
  }
  return corrected;
}

}  // namespace vo
