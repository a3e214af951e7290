// What a landmark's residuals say of its noise, against draws whose variance is known.
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

// After `count` matches whose errors have `times` the covariance that they are said to have, of a landmark with this covariance in the image.
double Inflation(double times, int count, const Matrix2d& of_landmark, unsigned seed) {
  vo_test::Draws draws(seed);
  vo::ResidualHistory history;
  const Matrix2d root = (times * kR + of_landmark).llt().matrixL();
  for (int i = 0; i < count; ++i) {
    const Vector2d r = root * draws.Normals<2>();
    history.Add(vo::Residual::Of(r, of_landmark, kR));
  }
  return history.Inflation();
}

double Mean(double times, int count, const Matrix2d& of_landmark) {
  constexpr int kLandmarks = 400;
  double sum = 0;
  for (unsigned seed = 1; seed <= kLandmarks; ++seed) sum += Inflation(times, count, of_landmark, seed) / kLandmarks;
  return sum;
}

// The mean of 400 landmarks; of each some 50 matches of two degrees of freedom count, so one has a standard deviation of a seventh, the mean of a
// hundred and fortieth: bounds are four of them (a false alarm in 16 000).
TEST(ResidualHistory, LearnsTheVariance) {
  EXPECT_EQ(vo::ResidualHistory().Inflation(), 2);
  EXPECT_NEAR(Mean(1, 400, Matrix2d::Zero()), 2, 4 * 2.0 / 140);
  // Honest beforehand: 8 of 58 matches.
  const double expected = 2 * (8 + 50 * 3.0) / 58;
  EXPECT_NEAR(Mean(3, 400, Matrix2d::Zero()), expected, 4 * expected / 140);
  EXPECT_NEAR(Mean(0.04, 400, Matrix2d::Zero()), 1, 1e-9) << "never less than what the image says";
  EXPECT_NEAR(Mean(100, 400, Matrix2d::Zero()), vo::ResidualHistory::kMost, 1e-9);
}

// A landmark that is known less well than it is seen has large residuals for that reason, and they say little.
TEST(ResidualHistory, IsNotMisledByWhatIsNotKnownOfTheLandmark) {
  EXPECT_NEAR(Mean(1, 400, kR), 2, 4 * 2.0 / 140);
  EXPECT_NEAR(Mean(1, 400, 25 * kR), 2, 4 * 2.0 / 140);
  EXPECT_LT(Mean(3, 20, 25 * kR), 2.1) << "twenty glances at it are hardly one";
  EXPECT_GT(Mean(3, 20, Matrix2d::Zero()), 3.5);
}

TEST(ResidualHistory, Forgets) {
  vo::ResidualHistory history;
  for (int i = 0; i < 100; ++i) history.Add({10, 1});
  EXPECT_GT(history.Inflation(), 15);
  int frames = 0;
  for (; history.Inflation() > 2.5; ++frames) history.Add({1, 1});
  EXPECT_GT(frames, 50);
  EXPECT_LT(frames, 250);
}

}  // namespace
