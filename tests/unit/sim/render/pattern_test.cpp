#include <gtest/gtest.h>

#include <glm/vec2.hpp>
#include <set>
#include <vector>

#include "sim/render/sample_pattern.h"

namespace sim {
namespace {

// In each aligned run of 2^k points, scrambled or not, every elementary interval of area 2^-k holds exactly one.
TEST(Pattern, IsANetInEveryAlignedRun) {
  for (const PatternPoint scramble : {PatternPoint{}, PixelScramble(42, 17, 3).point}) {
    for (const std::uint32_t k : {1u, 4u, 6u, 8u}) {
      const std::uint32_t n = 1u << k;
      for (const std::uint32_t first : {0u, n, 5 * n}) {
        for (std::uint32_t split = 0; split <= k; ++split) {  // intervals 2^-split wide, 2^-(k - split) high
          std::vector<int> count(n);
          for (std::uint32_t i = first; i < first + n; ++i) {
            const PatternPoint p = SobolPoint(i);
            const std::uint64_t column = (std::uint64_t{p.u ^ scramble.u} << split) >> 32;
            const std::uint64_t row = (std::uint64_t{p.v ^ scramble.v} << (k - split)) >> 32;
            ++count[(row << split) + column];
          }
          EXPECT_EQ(count, std::vector<int>(n, 1)) << "n " << n << " first " << first << " split " << split;
        }
      }
    }
  }
}

// Mean of n sample points on a light: its middle. None is beyond its edge, at which some of 35 and more are clamped.
TEST(Pattern, PointsOnALightHaveItsMiddleAsTheirMean) {
  for (int n = 1; n <= 256; ++n) {
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& point : PointsOnLight(n)) {
      for (int c = 0; c < 2; ++c) {
        EXPECT_GE(point[c], 0.0) << n;
        EXPECT_LE(point[c], 1.0) << n;
      }
      mean += point / static_cast<double>(n);
    }
    EXPECT_NEAR(mean.x, 0.5, n < 35 ? 1e-9 : 2e-4) << n;
    EXPECT_NEAR(mean.y, 0.5, n < 35 ? 1e-9 : 2e-4) << n;
  }
}

TEST(Pattern, PixelBitsAreAFunctionOfTheKeyAndThePixel) {
  const PatternPoint a = PixelScramble(1, 2, 3).point, again = PixelScramble(1, 2, 3).point;
  EXPECT_EQ(a.u, again.u);
  EXPECT_EQ(a.v, again.v);
  std::set<std::uint32_t> seen;
  for (const std::uint64_t key : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{1} << 32}) {
    for (std::uint32_t x = 0; x < 10; ++x) {
      for (std::uint32_t y = 0; y < 10; ++y) {
        seen.insert(PixelScramble(key, x, y).point.u);
        seen.insert(PixelScramble(key, x, y).point.v);
      }
    }
  }
  EXPECT_EQ(seen.size(), 600u);  // 600 of 2^32: two equal with probability 4e-5; the bits are fixed
}

TEST(Pattern, UnitNumbersStayInside) {
  EXPECT_GT(ToUnit(0), 0.0);
  EXPECT_LT(ToUnit(0xffffffffu), 1.0);
}

}  // namespace
}  // namespace sim
