// A rolling shutter after a gap: the velocity that straightens the rows of the first image back follows from the whole gap, not from one frame's time.
#include "vo/last_seen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/unit/vo/texture.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"
#include "vo/odometry.h"

namespace {

using Eigen::Vector3d;

// By hand: position and velocity of one axis after T, both from a velocity of variance V and white acceleration of density q, have the variance
// V T^2 + q T^3 / 3 and the covariance V T + q T^2 / 2.
TEST(VelocityChange, IsOverTheWholeGap) {
  const vo::MotionParams motion{.position_noise = 2.5, .orientation_noise = 1};
  vo::LastSeen last;
  last.velocity_covariance.setZero();
  last.velocity_covariance.diagonal() << 0.04, 0.09, 0.0, 0.01, 0.25, 0.0;
  vo::Vector6 off;
  off << 0.1, -0.2, 0.05, 0.02, -0.03, 0.04;
  for (const double T : {1.0 / 30, 0.7, 3.0}) {
    last.ago = T;
    const vo::Vector6 change = vo::VelocityChange(last, motion, off);
    for (int i = 0; i < 6; ++i) {
      const double V = last.velocity_covariance(i, i), q = i < 3 ? 6.25 : 1;
      EXPECT_NEAR(change[i], (V * T + q * T * T / 2) / (V * T * T + q * T * T * T / 3) * off[i],
                  1e-13 * std::abs(change[i]))
          << T << " s, axis " << i;
    }
    EXPECT_NEAR(change[2], 1.5 / T * off[2], 1e-13 / T) << "a velocity that was known";
  }
}

const vo::Camera kCamera{320, 240, 260, 260, 159.5, 119.5};
constexpr double kReadout = 0.026;

vo::Pose TruthAt(double t) {
  return {Vector3d(0.25 * std::sin(1.9 * t), 0.15 * std::sin(2.6 * t), 0.1 * std::sin(1.3 * t)),
          vo::Exp({0.05 * std::sin(1.7 * t), 0.08 * std::sin(1.1 * t), 0.04 * std::sin(2.1 * t)})};
}

// A wall two metres ahead, which bends away to the right, by a camera that takes its rows one after the other.
cv::Mat ViewAt(double stamp, const vo_test::Texture& texture) {
  cv::Mat image(kCamera.height, kCamera.width, CV_8UC1);
  for (int y = 0; y < kCamera.height; ++y) {
    const vo::Pose pose = TruthAt(stamp + kReadout * (y / (kCamera.height - 1.0) - 0.5));
    const Eigen::Matrix3d R = pose.q_WC.toRotationMatrix();
    for (int x = 0; x < kCamera.width; ++x) {
      const Vector3d ray = R * Vector3d((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
      Vector3d X = pose.p_WC + ray * (2 - pose.p_WC.z()) / ray.z();
      if (X.x() > 0) X = pose.p_WC + ray * (2 + 0.5 * pose.p_WC.x() - pose.p_WC.z()) / (ray.z() - 0.5 * ray.x());
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(texture.At(X.head<2>()));
    }
  }
  return image;
}

// Orientation error [rad] of the first image after so many dark ones.
double ErrorAfter(int dark, int lag) {
  constexpr int kLit = 25;
  const vo_test::Texture texture(2, 40.0, 24);
  vo::Params params;
  params.features.grid_columns = 6;
  params.features.grid_rows = 4;
  params.features.per_cell = 2;
  params.features.readout_s = kReadout;
  params.filter.start_window = 15;
  params.filter.lag = lag;
  vo::Prior prior;
  prior.pose = TruthAt(0);
  prior.v_WC = (TruthAt(0.01).p_WC - TruthAt(0).p_WC) / 0.01;
  prior.w_WC_C = vo::Log(TruthAt(0).q_WC.conjugate() * TruthAt(0.01).q_WC) / 0.01;
  prior.velocity_covariance = 1e-3 * vo::Matrix6::Identity();
  vo::Odometry odometry(kCamera, params, prior, 1);
  vo::Estimate estimate;
  const cv::Mat black(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(90));
  for (int k = 0; k <= kLit + dark; ++k)
    estimate =
        odometry.Track({k * 33'333'333LL, k >= kLit && k < kLit + dark ? black : ViewAt(k * 33'333'333e-9, texture)});
  EXPECT_TRUE(estimate.diagnostics.tracked());
  return vo::Minus(estimate.pose, TruthAt((kLit + dark) * 33'333'333e-9)).tail<3>().norm();
}

// Given the pose after T, what nearly constant velocity leaves of the velocity's variance is q T / 4 at the least: so far, in half the readout, the
// outermost rows may be off. With the gain of one frame's time it was 7 mrad after 5 dark frames, and 93 after 20.
TEST(LastSeen, StraightensTheFirstImageAfterAGap) {
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
