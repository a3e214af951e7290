// Rolling-shutter correction of a window: measurements of its rows, referred to the frames' stamps by the velocities
// along a solution. The rotation between row and stamp is taken out of the image point; the translation v dt remains as
// an offset of the camera's centre, or is taken out with the landmark's depth as well.
#pragma once

#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/window.h"

namespace vo {

// Centre of projection of the corrected image points. row_pose: the centre at the row's time. frame_pose: the centre at
// the stamp; used as long as the window is open, because an offset v dt is a metric baseline, which would hold the
// scale of the first guess and count as information on it.
enum class ShutterReference { row_pose, frame_pose };

// Slots from `first` to `last` of a window; -1: the sampled pose before it.
struct SlotRange {
  int first, last;
  bool contains(int slot) const { return slot >= first && slot <= last; }
};

struct CorrectedWindow {
  Window window;
  std::vector<Landmark> landmarks;  // from their corrected first views
};

// Matches of these slots, and landmarks that were first seen there. Each row is corrected from its measurement, not
// from an earlier correction. `first_views`: per landmark; no update has changed those of the slots yet.
// `rates`: with the path's rates of rows.
CorrectedWindow CorrectShutter(const Window& window, const LandmarkTable& table, std::span<const FirstView> first_views,
                               const WindowInput& in, const PathSolution& solution, SlotRange slots,
                               ShutterReference reference, bool rates, const LandmarkParams& params);

// Parabola through three poses of a path: (v in W, w in C) at the middle one, and its derivative.
struct PoseMotion {
  Vector6 velocity, acceleration;
  Vector6 MeanVelocity(double time) const { return velocity + time / 2 * acceleration; }  // until then
};
// At the start of the window and at each of its poses, without the prior, whose error would shear the map of the first
// frame permanently. At the last pose the mean velocity of its step: with a parabola's weight of 3/2 on that pose the
// alternation of corrections and solution diverges.
std::vector<PoseMotion> MotionsAlong(const Window& window, const Pose& start, const PathGaussian& path);

}  // namespace vo
