// Noise of a landmark estimated from its residuals, against draws of known variance.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "vo/map/landmark_record.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const Matrix2d kR = (Matrix2d() << 0.09, 0.02, 0.02, 0.04).finished();

// Inflation after `count` matches whose errors have `times` their stated covariance, of a landmark with this covariance
// in the image; at level 1.
double Inflation(double times, int count, const Matrix2d& of_landmark, unsigned seed) {
  vo_test::Draws draws(seed);
  vo::ResidualHistory history;
  const Matrix2d root = (times * kR + of_landmark).llt().matrixL();
  for (int i = 0; i < count; ++i) {
    const Vector2d r = root * draws.Normals<2>();
    history.Add(vo::Residual::Of(r, of_landmark, kR));
  }
  return history.Inflation(1);
}

double Mean(double times, int count, const Matrix2d& of_landmark) {
  constexpr int kLandmarks = 400;
  double sum = 0;
  for (unsigned seed = 1; seed <= kLandmarks; ++seed) sum += Inflation(times, count, of_landmark, seed) / kLandmarks;
  return sum;
}

// Mean over 400 landmarks. About 50 matches of two degrees of freedom count for each, so that one has a standard
// deviation of 1/7, the mean of 1/140. Bounds of four standard deviations: false-alarm rate 1 in 16 000.
TEST(ResidualHistory, LearnsTheVariance) {
  EXPECT_EQ(vo::ResidualHistory().Inflation(5), 5);
  EXPECT_NEAR(Mean(1, 400, Matrix2d::Zero()), 1, 4 * 1.0 / 140);
  for (const double times : {0.3, 3.0}) {  // the level counts for 3 of 53 matches
    const double expected = (3 + 50 * times) / 53;
    EXPECT_NEAR(Mean(times, 400, Matrix2d::Zero()), expected, 4 * expected / 140);
  }
  EXPECT_NEAR(Mean(0.01, 400, Matrix2d::Zero()), vo::ResidualHistory::kLeast, 1e-9);
  EXPECT_NEAR(Mean(400, 400, Matrix2d::Zero()), vo::ResidualHistory::kMost, 1e-9);
}

// Landmarks of larger covariance in the image than the noise: large residuals are no evidence of noise, and the level
// stays.
TEST(ResidualHistory, LeavesOutWhatIsNotKnownOfTheLandmark) {
  EXPECT_NEAR(Mean(1, 400, kR), 1, 4 * 1.0 / 70);
  EXPECT_NEAR(Mean(1, 400, 25 * kR), 1, 4 * 1.0 / 70);
  EXPECT_LT(Mean(3, 20, 25 * kR), 1.1);
  EXPECT_GT(Mean(3, 20, Matrix2d::Zero()), 2.2);
}

// Landmark of unknown depth: residuals across the epipolar line are evidence of noise.
TEST(ResidualHistory, UsesTheDirectionThatIsKnown) {
  const Matrix2d unknown_depth = Vector2d(1e4, 0).asDiagonal();
  EXPECT_GT(Mean(3, 20, unknown_depth), 2);
}

TEST(ResidualHistory, Forgets) {
  vo::ResidualHistory history;
  for (int i = 0; i < 100; ++i) history.Add({10, 1});
  EXPECT_GT(history.Inflation(1), 9);
  int frames = 0;
  for (; history.Inflation(1) > 1.5; ++frames) history.Add({1, 1});
  EXPECT_GT(frames, 50);
  EXPECT_LT(frames, 250);
}

}  // namespace
