#include "tools/judge/evaluation/draws.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tools/judge/evaluation/distributions.h"

namespace evaluation {
namespace {

TEST(Philox, IsRandom123s) {
  // Known answers of Random123's kat_vectors.
  EXPECT_EQ(Philox({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(Philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto theirs = r123::Philox4x32()({{i, 7 * i, ~i, 3}}, {{i * i, 5}});
    EXPECT_EQ(Philox({i, 7 * i, ~i, 3}, {i * i, 5}),
              (std::array<std::uint32_t, 4>{theirs[0], theirs[1], theirs[2], theirs[3]}));
  }
}

TEST(Draws, AreAFunctionOfSeedAndStream) {
  Draws a(1, 2), b(1, 2), other_stream(1, 3), other_seed(2, 2);
  const Eigen::VectorXd values = a.Normals(50);
  EXPECT_EQ(values, b.Normals(50));
  EXPECT_NE(values, other_stream.Normals(50));
  EXPECT_NE(values, other_seed.Normals(50));
}

// Definition of the draws: words of Philox in order, both halves of seed and stream in its arguments; normals by
// Box-Muller, in pairs.
TEST(Draws, AreMadeOfThoseWords) {
  const std::uint64_t seed = 0x0123456789abcdef, stream = 0xfedcba9876543210;
  std::vector<double> uniform;
  for (std::uint32_t block = 0; block < 3; ++block)
    for (const std::uint32_t word : Philox({block, 0, 0x76543210, 0xfedcba98}, {0x89abcdef, 0x01234567}))
      uniform.push_back((word + 0.5) / 4294967296.0);
  Draws draws(seed, stream), normal(seed, stream);
  for (const double value : uniform) EXPECT_EQ(draws.Uniform(), value);
  for (std::size_t i = 0; i < uniform.size(); i += 2) {
    const double radius = std::sqrt(-2 * std::log(uniform[i]));
    EXPECT_NEAR(normal.Normal(), radius * std::cos(2 * M_PI * uniform[i + 1]), 1e-15);
    EXPECT_NEAR(normal.Normal(), radius * std::sin(2 * M_PI * uniform[i + 1]), 1e-15);
  }
}

// Mean, variance, fourth moment and dependence of neighbours of 200 000 normals, five standard deviations each:
// false-alarm rate 3e-6.
TEST(Draws, AreStandardNormal) {
  const int n = 200'000;
  Draws random(3);
  const Eigen::ArrayXd x = random.Normals(n);
  const double unit = 5 / std::sqrt(n);
  EXPECT_NEAR(x.mean(), 0, unit);
  EXPECT_NEAR(x.square().mean(), 1, unit * std::sqrt(2));
  EXPECT_NEAR(x.square().square().mean(), 3, unit * std::sqrt(96));
  EXPECT_NEAR((x.head(n - 1) * x.tail(n - 1)).mean(), 0, unit);
  EXPECT_NEAR((x.head(n - 1).square() * x.tail(n - 1).square()).mean(), 1,
              unit * std::sqrt(12));  // of one Box-Muller pair
}

}  // namespace
}  // namespace evaluation
