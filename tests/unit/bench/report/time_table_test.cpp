#include <gtest/gtest.h>

#include "tools/bench/result/system_summary.h"

namespace vobench::report {
namespace {

// Twenty-one frames: frame k takes k, 2 k and 0.5 ms, the last 100 ms in matching.
TEST(TimeTable, IsWorkedByHand) {
  std::vector<evaluation::FrameRecord> frames(21);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    frames[k].ms_features = static_cast<double>(k);
    frames[k].ms_matching = k == 20 ? 100 : 2 * static_cast<double>(k);
    frames[k].ms_filter = 0.5;
  }
  EXPECT_EQ(TimeTable(frames, 0.42),
            "Time per frame [ms]  median   95 %  longest\n"
            "features              10.00  19.00    20.00\n"
            "matching              20.00  38.00   100.00\n"
            "filter                 0.50   0.50     0.50\n"
            "all                   30.50  57.50   120.50\n"
            "21 frames in 0.42 s, read and tracked: 20.00 ms each, 50.0 a second.\n");
  EXPECT_EQ(TimeTable({}, 1), "");
}

}  // namespace
}  // namespace vobench::report
