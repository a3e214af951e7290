// Rotations of more than half a turn between two images, whose rotation vector is not the shortest one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "vo/geometry/so3.h"
#include "vo/point_odometry.h"

namespace {

using Eigen::Vector3d;

std::vector<std::pair<std::string, vo::FilterParams>> Members() {
  std::vector<std::pair<std::string, vo::FilterParams>> members(6);
  for (std::size_t n = 1; n < members.size(); ++n) members[n].second = vo_test::SampledAtOnce();
  members[0].first = "default";
  members[1].first = "sampled at once";
  members[1].second.start_window = 0;
  members[2].first = "lag";
  members[2].second.lag = 5;
  members[2].second.start_window = 0;
  members[3].first = "lag, equal weights";
  members[3].second.lag = 5;
  members[3].second.weight = vo::Weight::uniform;
  members[4].first = "ukf";
  members[4].second.proposal = vo::Proposal::ukf;
  members[5].first = "ekfslam";
  members[5].second.sampled = vo::Sampled::nothing;
  return members;
}

vo::PointFrame Frame(double time, std::vector<vo::PointObservation> observations = {}) {
  return {std::llround(time * 1e9), std::move(observations)};
}

// Coasting through one, two and many half turns, and through whole ones: the velocity's mean is constant, and its
// variance grows by the process noise.
TEST(LongTurn, CoastingKeepsTheVelocity) {
  for (const auto& [name, filter] : Members()) {
    for (const Vector3d& w : {Vector3d(0, 1, 0), Vector3d(0, 0, 2 * std::numbers::pi), Vector3d(0.6, -1.1, 0.8)}) {
      vo::Params params;
      params.filter = filter;
      vo::Prior prior;
      prior.v_WC = {0.2, 0, -0.1};
      prior.w_WC_C = w;
      vo::PointOdometry odometry(vo::Camera{}, params, prior, 1);
      const double psd = std::pow(params.motion.orientation_noise, 2);
      odometry.Track(Frame(0));
      for (int k = 1; k <= 100; ++k) {
        const double time = 0.1 * k;
        const vo::Estimate estimate = odometry.Track(Frame(time));
        ASSERT_LT((estimate.w_WC_C - w).norm(), 1e-6) << name << " after " << time << " s of " << w.transpose();
        ASSERT_LT((estimate.v_WC - prior.v_WC).norm(), 1e-9) << name << " after " << time << " s";
        const vo::Matrix6 P = estimate.covariance.bottomRightCorner<6, 6>();
        const Eigen::Matrix3d expected =
            prior.velocity_covariance.bottomRightCorner<3, 3>() + psd * time * Eigen::Matrix3d::Identity();
        ASSERT_LT((P.bottomRightCorner<3, 3>() - expected).norm(), 1e-4 * expected.norm())
            << name << " after " << time << " s of " << w.transpose();
      }
    }
  }
}

// One second of images of points all around, then none for most of a turn, until the points of the first second are in
// view again: the velocity is that of the whole rotation. False-alarm rate of five standard deviations of an axis: 1 in
// two million.
TEST(LongTurn, IsTheOneThatLedToTheNextImage) {
  constexpr double kRate = 10, kTurn = 1;  // [1/s], [rad/s]
  constexpr int kLit = 10, kDark = 48;     // frames
  const vo::Camera camera;
  for (const auto& [name, filter] : Members()) {
    if (filter.proposal == vo::Proposal::ukf) continue;  // over-confident: docs/odometry.md
    vo_test::Draws draws(7);
    std::vector<Vector3d> points;
    for (int n = 0; n < 400; ++n) points.push_back((3 + 2 * draws.Uniform()) * draws.Normals<3>().normalized());
    vo::Params params;
    params.filter = filter;
    params.motion = {.position_noise = 0.05, .orientation_noise = 0.03};
    vo::Prior prior;
    prior.v_WC = {0.2, 0, 0};
    prior.w_WC_C = {0, kTurn, 0};
    prior.velocity_covariance = 0.01 * vo::Matrix6::Identity();
    vo::PointOdometry odometry(camera, params, prior, 1);
    for (int k = 0; k <= kLit + kDark + 5; ++k) {
      const double time = k / kRate;
      const vo::Pose pose{time * prior.v_WC, vo::Exp({0, kTurn * time, 0})};
      std::vector<vo::PointObservation> seen;
      for (std::size_t n = 0; n < points.size(); ++n) {
        const Vector3d X = pose.q_WC.conjugate() * (points[n] - pose.p_WC);
        const Eigen::Vector2d noise = params.features.sigma_px * draws.Normals<2>();
        if (X.z() > 0.5 * X.norm()) seen.push_back({static_cast<std::int64_t>(n), camera.Project(X / X.z()) + noise});
      }
      const bool dark = k > kLit && k <= kLit + kDark;
      const vo::Estimate estimate = odometry.Track(Frame(time, dark ? std::vector<vo::PointObservation>() : seen));
      if (k <= kLit + kDark) continue;
      EXPECT_TRUE(estimate.diagnostics.tracked()) << name;
      for (int axis = 0; axis < 3; ++axis) {
        const double sigma = std::sqrt(estimate.covariance(9 + axis, 9 + axis));
        EXPECT_LT(sigma, 0.2) << name;
        EXPECT_NEAR(estimate.w_WC_C[axis], prior.w_WC_C[axis], 5 * sigma) << name << ", frame " << k;
      }
    }
  }
}

}  // namespace
