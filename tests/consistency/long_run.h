// Time per frame and memory over hours of motion through ever new landmarks.
// The world runs in a process of its own: its memory is not counted as the odometry's.
#pragma once

#include <cstddef>

namespace long_run {

// Time:    CPU time of the thread, tenth percentile of `window` frames: of those from `early` on, when the map is
//          full, and of the last ones. Each is divided by the same percentile of a fixed calculation made after every
//          frame, which cancels changes in the machine's speed. Bound on the growth: 25 %; printed.
// Memory:  resident, from frame `early` on at most 1 % above that of frame `early` (2 % up to 10 000 frames).
// A non-finite estimate ends the run (vo/filter/checked_filter.h).
struct Length {
  std::size_t frames = 0, early = 0, window = 0;
};

// scenes/points.yaml with a mean-reverting motion. In every frame the map has exactly the landmarks seen in the last
// forget_after frames.
void ExpectNothingGrowsOnPoints(const Length& length);

// tests/consistency/long_flight.yaml: images of 160 x 120. The same bound holds for the simulator's memory.
void ExpectNothingGrowsOnImages(const Length& length);

}  // namespace long_run
