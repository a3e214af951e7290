#include "sim/sensor/depth_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

constexpr int kWidth = 200, kHeight = 150;

std::vector<float> Wall(double z) { return std::vector<float>(kWidth * kHeight, static_cast<float>(z)); }

// Distribution of round(d + n), d = 351.3 m / Z, on a wall of constant depth. Pearson's chi-squared over the three
// commonest values and the rest, 3 degrees of freedom: beyond 30.66 with probability 1e-6. Control: twice the disparity
// noise is rejected.
TEST(DepthNoise, DisparitiesAreRoundedNoisyOnes) {
  const double disparity = 100.2, z = 351.30 / disparity;
  const std::vector<float> noisy = WithKinectNoise(Wall(z), kWidth, kHeight, 5, 0);
  double counts[3] = {}, n = 0;
  for (const float depth : noisy) {
    const double d = 351.30 / static_cast<double>(depth);
    ASSERT_NEAR(d, std::round(d), 1e-4);
    const double k = std::round(d) - 99;
    if (k >= 0 && k < 3) counts[static_cast<int>(k)] += 1;
    n += 1;
  }
  const auto score = [&](double sigma) {
    const auto below = [&](double x) { return 0.5 * std::erfc(-(x - disparity) / (sigma * std::sqrt(2.0))); };
    double chi2 = 0, rest = n, rest_expected = n;
    for (int k = 0; k < 3; ++k) {
      const double expected = n * (below(99.5 + k) - below(98.5 + k));
      chi2 += std::pow(counts[k] - expected, 2) / expected;
      rest -= counts[k];
      rest_expected -= expected;
    }
    return chi2 + (rest_expected > 1e-3 ? rest * rest / rest_expected : rest);
  };
  EXPECT_LT(score(1.0 / 6), 30.66);
  EXPECT_GT(score(2.0 / 6), 30.66);
}

// Lateral noise at a depth edge: a normal shift of standard deviation 0.5 px. A pixel whose border is the edge has the
// depth of the other side when its shift is beyond 0.5 px. 150 such pixels, binomial; false-alarm rate 1e-6 (4.9
// sigma).
TEST(DepthNoise, EdgesFray) {
  std::vector<float> depth = Wall(2);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 100; x < kWidth; ++x) depth[static_cast<std::size_t>(y * kWidth + x)] = 4;
  }
  const std::vector<float> noisy = WithKinectNoise(depth, kWidth, kHeight, 5, 3);
  const auto share_far = [&](int x) {
    double count = 0;
    for (int y = 0; y < kHeight; ++y) count += noisy[static_cast<std::size_t>(y * kWidth + x)] > 3 ? 1.0 / kHeight : 0;
    return count;
  };
  const double p = 0.5 * std::erfc(1 / std::sqrt(2.0));  // beyond one standard deviation
  EXPECT_NEAR(share_far(99), p, 4.9 * std::sqrt(p * (1 - p) / kHeight));
  EXPECT_EQ(share_far(90), 0);
  EXPECT_NEAR(share_far(110), 1, 1e-12);
}

TEST(DepthNoise, NothingStaysNothingAndTheKeyDecides) {
  EXPECT_EQ(WithKinectNoise(Wall(0), kWidth, kHeight, 1, 1), Wall(0));
  EXPECT_EQ(WithKinectNoise(Wall(3), kWidth, kHeight, 1, 1), WithKinectNoise(Wall(3), kWidth, kHeight, 1, 1));
  EXPECT_NE(WithKinectNoise(Wall(3), kWidth, kHeight, 1, 1), WithKinectNoise(Wall(3), kWidth, kHeight, 1, 2));
  EXPECT_EQ(WithKinectNoise(std::vector<float>{2.0f}, 1, 1, 1, 1).size(), 1u);
}

}  // namespace
}  // namespace sim
