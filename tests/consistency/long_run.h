// Purpose: many minutes of motion through ever new landmarks: does the filter stay as fast, and as small, as it was?
#pragma once

#include <cstddef>
#include <vector>

namespace long_run {

struct Frame {
  double cpu_s = 0;  // of the thread
  int landmarks = 0;
  int allowed = 0;                 // different points seen in this frame and the forget_after - 1 before it
  std::size_t resident_bytes = 0;  // every 100 frames, else 0
  bool finite = false;
};

// scenes/points.yaml with a motion that is drawn back to its start; all frames are made before the filter sees the
// first.
std::vector<Frame> Play(std::size_t frames);

// Median cpu_s of [first, last).
double MedianTime(const std::vector<Frame>& frames, std::size_t first, std::size_t last);

}  // namespace long_run
