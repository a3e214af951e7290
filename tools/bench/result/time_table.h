// Time per stage of an odometry [ms], as a table for a terminal.
#pragma once

#include <string>
#include <vector>

#include "tools/judge/evaluation/estimate_run.h"

namespace vobench {

// A row for each stage and one for all of them: median, 95th percentile and longest over the frames. `elapsed_s` is how
// long all frames took by the clock, reading them included: with stages side by side less than the sum. Empty for no
// frames.
std::string TimeTable(const std::vector<evaluation::FrameRecord>& frames, double elapsed_s);

}  // namespace vobench
