// Time and memory over ten minutes in a point world and two minutes of images. VOBENCH_LONG_RUN=H: H hours of each.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/consistency/long_run.h"

namespace {

std::size_t Frames(std::size_t usual) {
  const char* hours = std::getenv("VOBENCH_LONG_RUN");
  return hours != nullptr ? static_cast<std::size_t>(std::atof(hours) * 3600 * 30) : usual;
}

TEST(LongRunSlow, NothingGrowsOnPoints) { long_run::ExpectNothingGrowsOnPoints({Frames(18'000), 2000, 6000}); }

TEST(LongRunSlow, NothingGrowsOnImages) { long_run::ExpectNothingGrowsOnImages({Frames(3600), 1500, 600}); }

}  // namespace
