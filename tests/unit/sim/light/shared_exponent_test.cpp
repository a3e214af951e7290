// Shared-exponent coding of baked light: rounding error, exact values, range; and the order of the lattice.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "sim/render/baked_light.h"

namespace sim::test {
namespace {

glm::vec3 UnpackShared(std::uint32_t bits) {
  const float scale = std::ldexp(1.0f, static_cast<int>(bits >> 27) - 24);
  return scale * glm::vec3(static_cast<float>(bits & 511u), static_cast<float>((bits >> 9) & 511u),
                           static_cast<float>((bits >> 18) & 511u));
}

TEST(SharedExponent, HalfAStep) {
  for (float scale = 1e-5f; scale < 6e4f; scale *= 1.37f) {
    const glm::vec3 color(scale, 0.37f * scale, 0.011f * scale), back = UnpackShared(PackShared(color));
    for (int c = 0; c < 3; ++c)
      EXPECT_LE(std::abs(back[c] - color[c]), std::max(scale / 512, 0x1p-25f) * 1.001f) << scale << ", " << c;
  }
}

TEST(SharedExponent, ExactValuesAndTheEnds) {
  EXPECT_EQ(PackShared({0, 0, 0}), 0u);
  for (const float exact : {1.0f, 0.5f, 3.0f, 1.0f / 512, 65408.0f})
    EXPECT_EQ(UnpackShared(PackShared(glm::vec3(exact))), glm::vec3(exact));
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(UnpackShared(PackShared({nan, -1.0f, infinity})), glm::vec3(0, 0, 65408.0f));
  EXPECT_EQ(UnpackShared(PackShared(glm::vec3(0.99999f))), glm::vec3(1.0f));  // rounding carries into the exponent
}

TEST(Lattice, RowByRow) {
  for (const std::size_t r : {1u, 2u, 8u}) {
    std::size_t k = 0;
    for (std::size_t j = 0; j <= r; ++j) {
      for (std::size_t i = 0; i + j <= r; ++i) EXPECT_EQ(LatticeIndex(r, i, j), k++);
    }
    EXPECT_EQ(LatticeSize(r), k);
  }
}

}  // namespace
}  // namespace sim::test
