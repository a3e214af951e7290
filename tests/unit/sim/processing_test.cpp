// The point-spread function and each step of the image processing against values worked by hand.
#include "sim/sensor/processing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "sim/sensor/develop.h"
#include "sim/sensor/sensor.h"
#include "tests/unit/sim/flat_picture.h"

namespace sim {
namespace {

using testing::Each;
using testing::FloatNear;
using testing::HasSubstr;

TEST(GaussianBlur, OfAPointHasTheVarianceThatWasAskedFor) {
  for (const double sigma : {0.3, 0.8, 2.5}) {
    std::vector<float> point(41 * 31, 0.0f);
    point[15 * 41 + 20] = 1;
    const std::vector<float> spread = GaussianBlur(point, 41, 31, 1, sigma);
    double sum = 0, xx = 0, yy = 0;
    for (int i = 0; i < 41 * 31; ++i) {
      const double v = spread[static_cast<std::size_t>(i)], x = i % 41 - 20, y = i / 41 - 15;
      sum += v, xx += v * x * x, yy += v * y * y;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_NEAR(xx, sigma * sigma, 1e-3 * sigma * sigma) << "cut off where less than 1e-5 is left";
    EXPECT_NEAR(yy, sigma * sigma, 1e-3 * sigma * sigma);
    EXPECT_GT(std::abs(xx - 1.1 * sigma * sigma), 0.05 * sigma * sigma) << "a sigma 5 % off is told apart";
  }
}

TEST(GaussianBlur, LeavesAUniformPictureAndChannelsApart) {
  std::vector<float> picture;
  for (int i = 0; i < 9 * 7; ++i) picture.insert(picture.end(), {0.2f, 0.5f, 0.9f});
  const std::vector<float> blurred = GaussianBlur(picture, 9, 7, 3, 1.7);
  for (std::size_t i = 0; i < blurred.size(); ++i) EXPECT_NEAR(blurred[i], picture[i], 1e-6);
}

TEST(GaussianBlur, OfAStepIsTheDistributionFunction) {
  // T(0) = exp(-1) I_0(1) = 0.46576, T(1) = exp(-1) I_1(1) = 0.20791: (1 - T(0)) / 2 on the dark side of the step.
  std::vector<float> step(20, 0.0f);
  std::fill(step.begin() + 10, step.end(), 1.0f);
  const std::vector<float> blurred = GaussianBlur(step, 20, 1, 1, 1);
  EXPECT_NEAR(blurred[9], (1 - 0.46576) / 2, 1e-4);
  EXPECT_NEAR(blurred[8], (1 - 0.46576) / 2 - 0.20791, 1e-4);
}

TEST(CorrectColor, BalancesThenMixesAndClips) {
  ProcessingParams p;
  p.white_balance = {2, 1, 0.5};
  p.color_red = {1.5, -0.5, 0};
  std::vector<float> rgb = {0.2f, 0.4f, 0.6f, 0.5f, 0.1f, 0.1f, 0.0f, 0.9f, 0.0f};
  CorrectColor(p, rgb);
  EXPECT_NEAR(rgb[0], 1.5 * 0.4 - 0.5 * 0.4, 1e-6);
  EXPECT_NEAR(rgb[1], 0.4, 1e-6);
  EXPECT_NEAR(rgb[2], 0.3, 1e-6);
  EXPECT_EQ(rgb[3], 1) << "1.5 - 0.05";
  EXPECT_EQ(rgb[6], 0) << "-0.45";
}

TEST(ToneCurve, ByHand) {
  SensorParams p;
  p.response = Response::linear;
  p.processing.black_clip = 0.1, p.processing.contrast = 1.25, p.processing.toe = 2;
  const ToneCurve curve(p);
  EXPECT_NEAR(curve(0.1f), 0, 1e-6);
  EXPECT_NEAR(curve(0.5f), 0.25 / (0.25 + 0.5), 1e-4);  // e = 1/2
  EXPECT_EQ(curve(0.95f), 1);                           // e = 1.06
  p.processing = {.shoulder = 3};
  EXPECT_NEAR(ToneCurve(p)(0.75f), 0.75 / (0.75 + 1.0 / 64), 1e-4);
  p.processing = {};
  p.response = Response::srgb;
  for (const float x : {0.0f, 0.003f, 0.2f, 0.7f, 1.0f})
    EXPECT_NEAR(ToneCurve(p)(x), EncodeResponse(p, double{x}), 2e-5);
}

TEST(Denoise, WeighsByDistanceAndDifference) {
  ProcessingParams p;
  p.denoise_sigma_px = 0.6, p.denoise_range = 0.1;
  std::vector<float> picture(25, 0.5f);
  picture[12] = 0.6f;
  Denoise(p, 5, 5, 1, picture);
  // A difference of denoise_range halves the weights of the neighbours: four at distance 1, four at sqrt(2).
  const double w1 = std::exp(-0.5 / 0.36) / 2, w2 = std::exp(-1 / 0.36) / 2;
  EXPECT_NEAR(picture[12], (0.6 + 0.5 * 4 * (w1 + w2)) / (1 + 4 * (w1 + w2)), 1e-6);
  std::vector<float> step(36, 0.1f);
  for (std::size_t i = 0; i < 36; ++i) step[i] = i % 6 < 3 ? 0.1f : 0.9f;
  Denoise(p, 6, 6, 1, step);
  EXPECT_NEAR(step[2], 0.1, 0.8 * 3 * std::exp(-0.5 / 0.36) / 65) << "an edge of eight times the range stays";
}

TEST(Sharpen, ControlsBothHalos) {
  ProcessingParams p;
  p.sharpen_bright = 0.5, p.sharpen_dark = 1;
  std::vector<float> step(20, 0.4f);
  std::fill(step.begin() + 10, step.end(), 0.6f);
  Sharpen(p, 20, 1, 1, step);
  const double beside = 0.2 * (1 - 0.46576) / 2;  // GaussianBlur.OfAStepIsTheDistributionFunction
  EXPECT_NEAR(step[10], 0.6 + 0.5 * beside, 1e-5);
  EXPECT_NEAR(step[9], 0.4 - beside, 1e-5);
  EXPECT_NEAR(step[0], 0.4, 1e-5);
  std::vector<float> clipped = {0, 0, 0, 1, 1, 1};
  Sharpen(p, 6, 1, 1, clipped);
  EXPECT_THAT(clipped, testing::ElementsAre(0, 0, 0, 1, 1, 1));
}

// Order of the steps: the matrix in linear light, then the tone curve; every channel of a flat field without noise.
TEST(Processing, OfAFlatIsTheCurveOfTheMatrix) {
  SensorParams p;
  p.shot_noise = false, p.read_noise_e = 0;
  p.processing.white_balance = {1.5, 1, 0.8}, p.processing.toe = 1.4;
  const ToneCurve curve(p);
  for (const Mosaic mosaic : {Mosaic::none, Mosaic::demosaiced}) {
    p.mosaic = mosaic;
    const Image image = Sensor(p, 1).Capture(Flat(12, 10, {0.3f, 0.3f, 0.3f}), 0);
    ASSERT_EQ(image.data.size(), 360U);
    EXPECT_NEAR(image.data[165], 255 * curve(0.45f), 0.51);
    EXPECT_NEAR(image.data[166], 255 * curve(0.30f), 0.51);
    EXPECT_NEAR(image.data[167], 255 * curve(0.24f), 0.51);
  }
  p.bit_depth = 12;
  EXPECT_NEAR(Sensor(p, 1).Capture(Flat(12, 10, {0.3f, 0.3f, 0.3f}), 0).wide[166], 4095 * curve(0.30f), 0.6);
}

TEST(Processing, RefusesWhatItCannotDo) {
  SensorParams p;
  p.mosaic = Mosaic::raw;
  p.processing.sharpen_dark = 1, p.processing.white_balance.x = 2;
  try {
    Sensor(p, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("three channels"), HasSubstr("raw mosaic")));
  }
}

}  // namespace
}  // namespace sim
