// Hours of motion through ever new landmarks: does the odometry stay as fast, and as small, as it was?
// How:     the world is a process of its own, so that what it keeps is not counted as the odometry's.
#pragma once

#include <cstddef>

namespace long_run {

// Time:    CPU time of the thread, the tenth percentile of `window` frames: of those from `early` on, when the map is
//          full, and of the last ones. Each is divided by the same percentile of a fixed calculation made after every
//          frame, so that a machine which is slower at the end is not a frame that grows. Bound 25 %; printed.
// Memory:  resident, from frame `early` on at most 1 % above that of frame `early` (of a short run, 2 %).
// An answer that is no number ends it (vo/filter/watched_filter.h).
struct Length {
  std::size_t frames = 0, early = 0, window = 0;
};

// scenes/points.yaml with a motion that is drawn back to its start. Landmarks: those seen in the last forget_after
// frames, no others: exactly, in every frame.
void ExpectNothingGrowsOnPoints(const Length& length);

// tests/consistency/long_flight.yaml: images of 160 x 120. The simulator must not grow, either.
void ExpectNothingGrowsOnImages(const Length& length);

}  // namespace long_run
