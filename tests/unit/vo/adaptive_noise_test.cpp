// Process noise estimated on line.
#include "vo/filter/adaptive_noise.h"

#include <gtest/gtest.h>

#include "tests/unit/vo/draws.h"

namespace {

// Mean factors over the last frames, of steps that are white with `truth` times the model's density; the covariances of
// the ratios are `claimed` times those of a Kalman filter.
vo::MotionInput MeanInput(const vo::MotionInput& truth, double claimed) {
  constexpr int kFrames = 6000, kSettled = 1000;
  constexpr double kNoise = 1e-9;  // variance of the measured pose
  vo::Matrix6 model = vo::Matrix6::Identity() * 1e-4, measured = vo::Matrix6::Identity() * kNoise;
  model.bottomRightCorner<3, 3>() *= 0.1;
  vo::Matrix6 actual = model;
  actual.topLeftCorner<3, 3>() *= truth.position_noise;
  actual.bottomRightCorner<3, 3>() *= truth.orientation_noise;
  vo::AdaptiveNoise noise;
  vo::MotionInput mean{0, 0};
  for (int frame = 0; frame < kFrames; ++frame) {
    const vo::MotionInput used = noise.Input();
    vo::PoseGaussian predicted;
    predicted.covariance = model;
    predicted.covariance.topLeftCorner<3, 3>() *= used.position_noise;
    predicted.covariance.bottomRightCorner<3, 3>() *= used.orientation_noise;
    const vo::Vector6 change = vo::SampleNormal(vo::Vector6::Zero(), actual + measured,
                                                {1, vo::Stream::pose, static_cast<std::uint32_t>(frame), 0});
    const vo::Matrix6 gain = predicted.covariance * (predicted.covariance + measured).inverse();
    vo::PoseGaussian updated = predicted;
    updated.mean = vo::Plus(predicted.mean, gain * change);
    updated.covariance -= gain * predicted.covariance;
    predicted.covariance *= claimed;
    updated.covariance *= claimed;
    noise.Learn(vo::RatiosOf(predicted, updated), used);
    if (frame < kSettled) continue;
    mean.position_noise += noise.Input().position_noise / (kFrames - kSettled);
    mean.orientation_noise += noise.Input().orientation_noise / (kFrames - kSettled);
  }
  return mean;
}

// The estimate is an average over 20 independent frames, the mean over 5000 frames one over 250 of these: its standard
// deviation is 1.2 %. False alarm rate 2e-4: two limits of four standard deviations and the measured pose's share.
TEST(AdaptiveNoise, MeanIsTheTrueDensityTimesTheMargin) {
  constexpr double kMargin = 1.4;
  for (const double density : {16.0, 0.01}) {
    const vo::MotionInput mean = MeanInput({density, density / 2}, 1);
    EXPECT_NEAR(mean.position_noise / (kMargin * density), 1, 0.06);
    EXPECT_NEAR(mean.orientation_noise / (kMargin * density / 2), 1, 0.06);
  }
  EXPECT_GT(std::abs(MeanInput({16, 9}, 0.5).position_noise / (kMargin * 16) - 1), 0.5)
      << "halved covariances are seen";
}

TEST(AdaptiveNoise, NoiseThatWasUnderstatedIsReplaced) {
  const vo::MotionInput used{0.5, 3};
  EXPECT_FALSE(vo::AsShown(used, {1.9, 0.2}));
  const auto shown = vo::AsShown(used, {1.9, 7});
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->position_noise, 0.5);
  EXPECT_EQ(shown->orientation_noise, 21);
}

TEST(AdaptiveNoise, FailedPredictionIsWidenedByWhatItShows) {
  const vo::MotionInput used{2, 3, Eigen::Quaterniond(0, 1, 0, 0), 0.5};
  const vo::MotionInput wide = vo::Widened(used, {6, 100});
  EXPECT_EQ(wide.position_noise, 12);
  EXPECT_EQ(wide.orientation_noise, 60);
  EXPECT_EQ(wide.turn->coeffs(), used.turn->coeffs());
  EXPECT_EQ(wide.coasting_s, 0.5);
  EXPECT_EQ(vo::Widened({0.01, 0.01}, {6, 6}).position_noise, 6) << "no less than the settings";
}

}  // namespace
