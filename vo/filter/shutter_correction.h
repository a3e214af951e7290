// Rolling-shutter correction of a window: what its rows measured, referred to the frames' stamps by the velocities
// along a solution. The rotation between row and stamp is taken out of the image point; the translation v dt remains as
// an offset of the camera's centre, or is taken out with the landmark's depth as well.
#pragma once

#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/window.h"

namespace vo {

// Where the corrected image points are seen from. row_pose: the centre at the row's time. frame_pose: the centre at the
// stamp; used as long as the window is open, because an offset v dt is a metric baseline, which would hold the scale of
// the first guess and count as information on it.
enum class ShutterReference { row_pose, frame_pose };

struct CorrectedWindow {
  Window window;
  std::vector<Landmark> landmarks;  // from their corrected first views
};

// Each row is corrected from what it measured, not from an earlier correction. `first_views`: per landmark; no update
// has changed the landmarks yet.
CorrectedWindow CorrectShutter(const Window& window, const LandmarkTable& table, std::span<const FirstView> first_views,
                               const WindowInput& in, const PathSolution& solution, ShutterReference reference,
                               const LandmarkParams& params);

// (v in W, w in C) at the start of the window and at each of its poses, by the parabola through three poses. Without
// the prior, whose error would shear the map of the first frame for good.
std::vector<Vector6> VelocitiesAlong(const Window& window, const Pose& start, const PathGaussian& path);

}  // namespace vo
