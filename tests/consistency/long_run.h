// Purpose: many minutes of motion through ever new landmarks: does the filter stay as fast, and as small, as it was?
#pragma once

#include <cstddef>

namespace long_run {

// scenes/points.yaml with a motion that is drawn back to its start; all frames are made before the filter sees the
// first.
// Landmarks: those seen in the last forget_after frames, no others: exactly, in every frame.
// Time: of the first and of the last `window` frames the tenth that takes shortest, in this thread's own time. 10 % is
// what is asked for; the machine's clock and caches are shared, so that a test which must not fail for them allows 25 %,
// and the figure is printed. Memory: within 2 % of what it is at frame `early`.
void ExpectNothingGrows(std::size_t frames, std::size_t early, std::size_t window);

}  // namespace long_run
