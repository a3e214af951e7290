// Velocity correction over the whole of a gap, applied to the rows of a rolling shutter.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/unit/vo/two_walls.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/odometry.h"

namespace {

// Gain (V T + q T^2 / 2) / (V T^2 + q T^3 / 3) of one axis: covariance of velocity and position after T over the
// position's variance, with a velocity of variance V and white acceleration of density q.
TEST(VelocityCorrection, IsOverTheWholeGap) {
  const vo::MotionParams motion{.position_noise = 2.5, .orientation_noise = 1};
  vo::SinceUpdate last;
  last.velocity_covariance.setZero();
  last.velocity_covariance.diagonal() << 0.04, 0.09, 0.0, 0.01, 0.25, 0.0;
  vo::Vector6 off;
  off << 0.1, -0.2, 0.05, 0.02, -0.03, 0.04;
  for (const double T : {1.0 / 30, 0.7, 3.0}) {
    last.dt_s = T;
    const vo::Vector6 change = vo::VelocityCorrection(last, motion, off);
    for (int i = 0; i < 6; ++i) {
      const double V = last.velocity_covariance(i, i), q = i < 3 ? 6.25 : 1;
      EXPECT_NEAR(change[i], (V * T + q * T * T / 2) / (V * T * T + q * T * T * T / 3) * off[i],
                  1e-13 * std::abs(change[i]))
          << T << " s, axis " << i;
    }
    EXPECT_NEAR(change[2], 1.5 / T * off[2], 1e-13 / T) << "a velocity that was known";
  }
}

constexpr double kReadout = 0.026;

// Orientation error [rad] of the first image after `dark` dark ones.
double ErrorAfter(int dark, int lag) {
  constexpr int kLit = 25;
  const vo_test::Texture texture(2, 40.0, 24);
  vo::Params params = vo_test::SmallImageParams();
  params.features.readout_s = kReadout;
  params.filter.start_window = 15;
  params.filter.lag = lag;
  vo::Odometry odometry(vo_test::kCamera, params, vo_test::KnownStart(), 1);
  vo::Estimate estimate;
  const cv::Mat black(vo_test::kCamera.height, vo_test::kCamera.width, CV_8UC1, cv::Scalar(90));
  for (int k = 0; k <= kLit + dark; ++k)
    estimate = odometry.Track(
        {k * vo_test::kFrameNs,
         k >= kLit && k < kLit + dark ? black : vo_test::RolledView(vo_test::TruthAt, k, kReadout, texture)});
  EXPECT_TRUE(estimate.diagnostics.tracked());
  return vo::Minus(estimate.pose, vo_test::TruthAt(kLit + dark)).tail<3>().norm();
}

// Orientation error of the first image after a gap T. Given the pose after T, the velocity's variance under nearly
// constant velocity is at least q T / 4; the bound is its standard deviation times half the readout, at the outermost
// rows. With the gain of one frame's time the error is 7 mrad after 5 dark frames, and 93 after 20.
TEST(VelocityCorrection, StraightensTheFirstImageAfterAGap) {
  for (const int lag : {0, 5}) {
    const double without = ErrorAfter(0, lag);
    for (const int dark : {5, 20}) {
      const double error = ErrorAfter(dark, lag), gap = (dark + 1) / 30.0;
      std::printf("lag %d, %d dark frames: %.2f mrad, without %.2f\n", lag, dark, 1e3 * error, 1e3 * without);
      EXPECT_LT(error, without + kReadout / 2 * std::sqrt(gap) / 2) << dark << " dark frames, lag " << lag;
    }
  }
}

}  // namespace
