// Process noise estimated on line.
#include "vo/filter/adaptive_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/vo/draws.h"

namespace {

const Eigen::Quaterniond kOrientation(0.8, 0.36, -0.48, 0);

// Mean input over the last frames. Steps are white with `truth` times the model's density in the camera frame; the
// covariances of the poses are `claimed` times those of a Kalman filter.
vo::MotionInput MeanInput(const vo::Matrix6& truth, double claimed, bool failed = false) {
  constexpr int kFrames = 6000, kSettled = 1000;
  constexpr double kNoise = 1e-9;  // variance of the measured pose
  const vo::Matrix6 measured = vo::Matrix6::Identity() * kNoise;
  vo::Vector6 model = vo::Vector6::Constant(1e-2);  // standard deviations of a step
  model.tail<3>() *= 0.3;
  vo::Matrix6 R = vo::Matrix6::Identity();  // (p in C, delta) to (p in W, delta)
  R.topLeftCorner<3, 3>() = kOrientation.toRotationMatrix();
  const vo::Matrix6 actual = model.asDiagonal() * R * truth * R.transpose() * model.asDiagonal();
  vo::AdaptiveNoise noise;
  vo::MotionInput mean{0, 0};
  mean.shape.setZero();
  for (int frame = 0; frame < kFrames; ++frame) {
    const vo::MotionInput used = noise.Input(kOrientation);
    vo::Vector6 scale = model;
    scale.head<3>() *= std::sqrt(used.position_noise);
    scale.tail<3>() *= std::sqrt(used.orientation_noise);
    vo::PoseGaussian predicted{{Eigen::Vector3d::Zero(), kOrientation},
                               scale.asDiagonal() * used.shape * scale.asDiagonal()};
    const vo::Vector6 change = vo::SampleNormal(vo::Vector6::Zero(), actual + measured,
                                                {1, vo::Stream::pose, static_cast<std::uint32_t>(frame), 0});
    const vo::Matrix6 gain = predicted.covariance * (predicted.covariance + measured).inverse();
    vo::PoseGaussian updated = predicted;
    updated.mean = vo::Plus(predicted.mean, gain * change);
    updated.covariance -= gain * predicted.covariance;
    predicted.covariance *= claimed;
    updated.covariance *= claimed;
    noise.Learn(predicted, updated, used, failed);
    if (frame < kSettled) continue;
    const vo::MotionInput input = noise.Input(kOrientation);
    mean.position_noise += input.position_noise / (kFrames - kSettled);
    mean.orientation_noise += input.orientation_noise / (kFrames - kSettled);
    mean.shape += R.transpose() * input.shape * R / (kFrames - kSettled);
  }
  return mean;
}

constexpr double kTypical = 0.7;  // share of the mean that a prediction takes

// Mean of the estimated density, kTypical times the true one. One estimate averages 20 independent frames, the mean
// over 5000 frames 250 estimates: its standard deviation is 1.2 %, that of one axis 2 %. False-alarm rate 2e-4: two
// limits of four standard deviations and the measured pose's share.
TEST(AdaptiveNoise, MeanIsTheTypicalShareOfTheTrueDensity) {
  for (const double density : {16.0, 0.01}) {
    vo::Vector6 truth = vo::Vector6::Constant(density);
    truth.tail<3>() /= 2;
    const vo::MotionInput mean = MeanInput(truth.asDiagonal(), 1);
    EXPECT_NEAR(mean.position_noise / (kTypical * density), 1, 0.06);
    EXPECT_NEAR(mean.orientation_noise / (kTypical * density / 2), 1, 0.06);
  }
  EXPECT_GT(std::abs(MeanInput(vo::Matrix6::Identity() * 16, 0.5).position_noise / (kTypical * 16) - 1), 0.5)
      << "halved covariances are seen";
}

// Shape 0.8 Q + 0.2 I of the process noise of a camera that pitches as it rises, Q the true one. The mean of an entry
// has a standard deviation of 2 % of at most 1.8. False-alarm rate 2e-3: 36 limits of four standard deviations, and the
// bias of a ratio.
TEST(AdaptiveNoise, ShapeIsThatOfTheMotionInTheCamera) {
  vo::Matrix6 truth = vo::Vector6(0.5, 2, 0.5, 1.6, 1.2, 0.2).asDiagonal();
  truth(1, 3) = truth(3, 1) = 1.6;
  const vo::Matrix6 shape = MeanInput(truth, 1).shape;
  const vo::Matrix6 expected = 0.8 * truth + 0.2 * vo::Matrix6::Identity();
  EXPECT_LT((shape - expected).cwiseAbs().maxCoeff(), 0.16) << shape;
  EXPECT_GT((shape - vo::Matrix6::Identity()).cwiseAbs().maxCoeff(), 1) << "no shape at all is seen";
  const vo::Matrix6 of_failed = MeanInput(truth, 1, true).shape;
  EXPECT_LT((of_failed - vo::Matrix6::Identity()).cwiseAbs().maxCoeff(), 1e-9) << "of failed predictions it is none";
}

TEST(AdaptiveNoise, NoiseThatWasUnderstatedIsReplaced) {
  const vo::MotionInput used{0.5, 3};
  EXPECT_FALSE(vo::Inflated(used, {1.9, 0.2}));
  const auto shown = vo::Inflated(used, {1.9, 7});
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->position_noise, 0.5);
  EXPECT_EQ(shown->orientation_noise, 21);
}

TEST(AdaptiveNoise, FailedPredictionIsWidenedByWhatItShows) {
  vo::MotionInput used{2, 3, 2 * vo::Matrix6::Identity(), Eigen::Quaterniond(0, 1, 0, 0), 0.5};
  const vo::MotionInput wide = vo::Widened(used, {6, 100});
  EXPECT_EQ(wide.shape, vo::Matrix6::Identity());
  EXPECT_EQ(wide.position_noise, 12);
  EXPECT_EQ(wide.orientation_noise, 60);
  EXPECT_EQ(wide.turn->coeffs(), used.turn->coeffs());
  EXPECT_EQ(wide.coasting_s, 0.5);
  EXPECT_EQ(vo::Widened({0.01, 0.01}, {6, 6}).position_noise, 6) << "no less than the settings";
}

}  // namespace
