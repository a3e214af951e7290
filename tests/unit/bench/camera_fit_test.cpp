// Camera statistics from images of known noise, edges and shading.
#include "tools/bench/camera_fit/camera_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace vobench {
namespace {

constexpr double kZ = 4.8916;  // P(|z| > kZ) = 1e-6, two-sided

cv::Mat Noisy(const cv::Mat& mean, double sigma, std::uint64_t seed) {  // CV_32FC1
  cv::Mat noise(mean.size(), CV_32F);
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, sigma);
  return mean + noise;
}

cv::Mat Codes(const cv::Mat& picture) {
  cv::Mat codes;
  picture.convertTo(codes, CV_8U);
  return codes;
}

Pair Still(const cv::Mat& picture, const cv::Mat& next) {
  Pair pair{Codes(picture), Codes(next), {}};
  for (int x = 0; x < picture.cols; x += 40) {
    for (int y = 0; y < picture.rows; y += 40) pair.motions.push_back({cv::Point2f(cv::Point(x, y)), {}});
  }
  return pair;
}

// White noise. Relative variance of a block's variance: 2 c / 256, c = (1 + 2 (4/6)^2 + 2 (1/6)^2)^2 = 3.78 for the
// filter's correlation; the deviation of its root is half of that, of a median of n 1.2533 times that over sqrt(n). The
// smaller of two medians lies lower by 0.56 of that. Rounding adds 1/12 to the variance. Control: a sigma 6 % off.
TEST(MeasureNoise, OfWhiteNoise) {
  const cv::Mat flat(960, 1280, CV_32F, cv::Scalar(101));
  const Pair pair = Still(Noisy(flat, 2, 1), Noisy(flat, 2, 2));
  const NoiseStatistics noise = MeasureNoise({&pair, 1});
  ASSERT_EQ(noise.levels.size(), 1U);
  EXPECT_NEAR(noise.levels[0].code, 101, 0.2);
  const double blocks = 78 * 58 / 20, deviation = 1.2533 * std::sqrt(3.78 / 512) / std::sqrt(blocks);
  const double expected = std::sqrt(4 + 1.0 / 12);
  EXPECT_NEAR(noise.levels[0].sigma / expected, 1, (kZ + 0.56) * deviation);
  EXPECT_GT(std::abs(noise.levels[0].sigma / (1.06 * expected) - 1), (kZ + 0.56) * deviation) << "6 % off is rejected";
  EXPECT_NEAR(noise.lattice, 1, 0.1);
  // Correlation after removal of a Gaussian of 2 px: (g4(1) g4(0) - 2 g2(1) g2(0)) / (1 - 2 g2(0)^2 + g4(0)^2), g2 of
  // variance 4, g4 of 8; and of the block's mean: 1/256. 1130 blocks: standard deviation 0.002.
  EXPECT_NEAR(noise.correlation[0], -0.0548 - 0.0039, kZ * 0.002);
}

TEST(MeasureNoise, OfCorrelatedNoiseAndOfAMosaic) {
  const cv::Mat flat(480, 640, CV_32F, cv::Scalar(101));
  const auto smooth = [&](std::uint64_t seed) {
    cv::Mat out;
    cv::blur(Noisy(flat, 4, seed), out, {2, 1});
    return out;
  };
  const Pair pair = Still(smooth(1), smooth(2));
  const NoiseStatistics noise = MeasureNoise({&pair, 1});
  EXPECT_NEAR(noise.correlation[0], 0.45, 0.05) << "1/2, less what the Gaussian takes out";
  EXPECT_LT(noise.correlation[1], 0.05);
  const auto lattice = [&](std::uint64_t seed) {
    cv::Mat out = Noisy(flat, 4, seed);
    const cv::Mat quiet = Noisy(flat, 2, seed + 10);
    for (int i = 0; i < 480 * 640; ++i) {
      if ((i / 640 + i) % 2 == 1) out.at<float>(i / 640, i % 640) = quiet.at<float>(i / 640, i % 640);
    }
    return out;
  };
  const Pair mosaic = Still(lattice(1), lattice(2));
  EXPECT_NEAR(MeasureNoise({&mosaic, 1}).lattice, 4, 0.6);
}

// A texture that moves by whole pixels does not add to the noise.
TEST(MeasureNoise, OfATextureInMotion) {
  cv::Mat texture = Noisy(cv::Mat(480, 648, CV_32F, cv::Scalar(101)), 8, 3);
  Pair pair = Still(Noisy(texture.colRange(8, 648), 1.5, 1), Noisy(texture.colRange(0, 640), 1.5, 2));
  for (Motion& motion : pair.motions) motion.by = {8, 0};
  EXPECT_NEAR(MeasureNoise({&pair, 1}).levels.at(0).sigma, std::sqrt(1.5 * 1.5 + 1.0 / 12), 0.15);
  for (Motion& motion : pair.motions) motion.by = {7, 0};
  EXPECT_GT(MeasureNoise({&pair, 1}).levels.at(0).sigma, 4) << "another motion";
}

// An edge of a Gaussian of sigma, blurred by a box of `blur` px along x.
cv::Mat EdgePicture(double sigma, double blur, double phase) {
  cv::Mat picture(240, 640, CV_32F);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 640; ++x) {
      const double from = std::abs(std::remainder(x - phase - 0.05 * y, 80)) - 20;
      double share = 0;
      for (int i = 0; i < 16; ++i)
        share += std::erfc((from + blur * ((i + 0.5) / 16 - 0.5)) / sigma / std::sqrt(2.0)) / 32;
      picture.at<float>(y, x) = static_cast<float>(50 + 140 * share);
    }
  }
  return picture;
}

TEST(FindEdges, WidthAndHalo) {
  const EdgeStatistics edges = Summarise(FindEdges(Codes(EdgePicture(1.2, 0, 3))));
  EXPECT_GT(edges.count, 500U);
  EXPECT_NEAR(edges.width, 2.5631 * 1.2, 0.15) << "linear interpolation between pixels widens it";
  EXPECT_LT(edges.bright, 0);
  cv::Mat sharp = EdgePicture(1.2, 0, 3), smooth;
  cv::GaussianBlur(sharp, smooth, {}, 1.5);
  const EdgeStatistics halo = Summarise(FindEdges(Codes(2 * sharp - smooth)));
  EXPECT_GT(halo.bright, edges.bright + 0.03);
  EXPECT_NEAR(halo.bright, halo.dark, 0.01);
}

// Pairs that move by 0 ... `fastest` px in a frame; exposure: `share` of the period of 40 ms.
Recording InMotion(double share, double fastest) {
  Recording recording;
  recording.period_s = 0.04;
  for (int k = 0; k < 25; ++k) {
    const double speed = fastest * k / 24;
    Pair pair = Still(EdgePicture(0.8, share * speed, 3 + k), EdgePicture(0.8, share * speed, 3 + k + speed));
    for (Motion& motion : pair.motions) motion.by = {static_cast<float>(speed), 0};
    recording.pairs.push_back(pair);
  }
  return recording;
}

TEST(FitExposure, WithinTwoMilliseconds) {
  EdgeStatistics at_rest;
  for (const double share : {0.2, 0.4}) {
    const auto exposure = FitExposure(InMotion(share, 6 / share), at_rest);
    ASSERT_TRUE(exposure);
    EXPECT_NEAR(exposure->value, 0.04 * share, 0.002);
  }
  EXPECT_NEAR(at_rest.width, 2.5631 * 0.8, 0.25) << "linear interpolation between pixels widens it";
  EXPECT_FALSE(FitExposure(InMotion(0.4, 1), at_rest)) << "too slow to blur anything";
  EXPECT_FALSE(FitExposure(InMotion(0.0, 20), at_rest)) << "no exposure at all";
}

// A texture that moves under a vignetting of 1 + v2 r^2.
Recording Shaded(double v2, int step) {
  cv::Mat texture = Noisy(cv::Mat(600, 1200, CV_32F, cv::Scalar(0)), 300, 5);
  cv::GaussianBlur(texture, texture, {}, 4);
  texture += 120;
  Recording recording;
  for (int r = 0; r < 3; ++r) {
    recording.runs.emplace_back();
    for (int k = 0; k < 12; ++k) {
      cv::Mat picture = texture(cv::Rect(100 * r + step * k, 60, 480, 360)).clone();
      for (int i = 0; i < 480 * 360; ++i) {
        const double x = i % 480 - 240, y = i / 480 - 180;
        picture.at<float>(i / 480, i % 480) *= static_cast<float>(1 + v2 * (x * x + y * y) / 90000);
      }
      recording.runs.back().push_back(Codes(picture));
    }
  }
  return recording;
}

TEST(FitVignetting, WithinATenth) {
  std::vector<double> linear;
  for (int i = 0; i < 256; ++i) linear.push_back(i / 255.0);
  const auto found = FitVignetting(Shaded(-0.4, 16), linear);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, -0.4, 0.04);
  EXPECT_NEAR(FitVignetting(Shaded(0, 16), linear)->value, 0, 0.02);
  EXPECT_FALSE(FitVignetting(Shaded(-0.4, 0), linear)) << "nothing moves";
}

}  // namespace
}  // namespace vobench
