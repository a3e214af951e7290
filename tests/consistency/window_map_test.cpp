// Uncertainty of the map in a window, from the measurements of the window and the covariance of its poses.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/particle_filter.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"
#include "vo/point_odometry.h"

namespace {

using Eigen::Vector3d;

// NEES of the first landmark of a world drawn from the filter's own prior, after half a second in a window.
struct Scores {
  double inverse_depth = 0, place = 0;
  double as_sampled = 0;  // of the inverse depth, conditional on the sampled poses, of which there are none
};

Scores Play(unsigned world) {
  constexpr int kFrames = 15, kCount = 40;
  constexpr double kSigma = 0.25 / 525;
  vo_test::Draws draws(world);
  vo::FilterParams params = vo_test::SampledAtOnce();
  params.particles = 1;
  params.marginal_mode = true;  // the joint mode's depths are biased
  const vo::LandmarkParams prior_of_depths{.inverse_depth = 0.25, .inverse_depth_sigma = 0.0125};
  const vo::MotionParams motion{.position_noise = 0.6, .orientation_noise = 0.4};
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::ParticleFilter filter(motion, params, prior_of_depths, prior, world);
  const Eigen::Matrix2d R = kSigma * kSigma * Eigen::Matrix2d::Identity();
  std::vector<Vector3d> points;
  std::vector<vo::FirstView> first;
  double truth = 0;
  for (int n = 0; n < kCount; ++n) {
    const Eigen::Vector2d ray = 0.4 * draws.Symmetrics<2>();
    const double rho = prior_of_depths.inverse_depth + prior_of_depths.inverse_depth_sigma * draws.Normal();
    if (n == 0) truth = rho;
    points.push_back(Vector3d(ray.x(), ray.y(), 1) / rho);
    first.push_back({ray + kSigma * draws.Normals<2>(), R});
  }
  filter.AddLandmarks(first);
  vo::Pose pose;
  vo::Vector6 velocity = 0.2 * draws.Normals<6>();
  for (int frame = 1; frame <= kFrames; ++frame) {
    const vo::Matrix12 L = vo::NearlyConstantVelocity(motion, 1.0 / 30).Q.llt().matrixL();
    const Eigen::Matrix<double, 12, 1> noise = L * draws.Normals<12>();
    pose = vo::Plus(pose, velocity / 30 + noise.head<6>());
    velocity += noise.tail<6>();
    std::vector<vo::Match> matches;
    for (int n = 0; n < kCount; ++n)
      matches.push_back(
          {n, (pose.q_WC.conjugate() * (points[n] - pose.p_WC)).hnormalized() + kSigma * draws.Normals<2>(), R});
    filter.Predict(1.0 / 30);
    filter.Update(matches);
  }
  const vo::Filter::LandmarkBelief belief = filter.LandmarkBeliefs()[0];
  const double error = belief.inverse_depth - truth;
  const auto [sigma, moments] = filter.LandmarkSpreads()[0];
  const vo::PointMoments place = *moments;
  const Vector3d off = place.mean - points[0];
  return {std::pow(error / sigma, 2), off.dot(place.covariance.inverse() * off),
          std::pow(error / belief.inverse_depth_sigma, 2)};
}

// Sums over 200 worlds, one landmark each: chi-square with 200 and 600 degrees of freedom. False-alarm rates: 1e-3.
TEST(WindowMap, CovarianceMatchesErrors) {
  constexpr int kWorlds = 200;
  Scores sum;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    const Scores scores = Play(world);
    sum.inverse_depth += scores.inverse_depth;
    sum.place += scores.place;
    sum.as_sampled += scores.as_sampled;
  }
  std::printf("inverse depth %.1f, place %.1f; by what is sampled %.1f\n", sum.inverse_depth, sum.place,
              sum.as_sampled);
  EXPECT_GT(sum.inverse_depth, 140.7);
  EXPECT_LT(sum.inverse_depth, 272.4);
  EXPECT_GT(sum.place, 492.4);
  EXPECT_LT(sum.place, 720.6);
  EXPECT_LT(sum.as_sampled, 140.7) << "the prior of the depths must show";
}

// Mean standard deviation of the inverse depths for sideways motion past sixty points. In the start window it falls in
// every frame, within 1 % for changes of linearisation; after it, where poses are sampled, it changes by less than a
// factor of 3 per frame: the common part of the depths' error is then the spread of eight samples, below a third of its
// value with a probability of 1/500.
TEST(WindowMap, CovarianceShrinks) {
  const vo::Camera camera;
  vo_test::Draws draws(5);
  std::vector<Vector3d> points;
  for (int n = 0; n < 60; ++n) {
    const Eigen::Vector2d ray = 0.4 * draws.Symmetrics<2>();
    points.push_back(Vector3d(ray.x(), ray.y(), 1) / (0.25 + 0.1 * draws.Symmetric()));
  }
  for (const int lag : {0, 5}) {
    vo::Params params;
    params.filter = vo_test::SampledAtOnce();
    params.landmark.scale_sigma = 0;
    params.filter.lag = lag;
    vo::PointOdometry odometry(camera, params, vo::Prior{}, 1);
    double before = params.landmark.inverse_depth_sigma;
    for (int frame = 0; frame <= 40; ++frame) {
      vo::PointFrame seen{frame * 33'333'333LL, {}};
      for (int n = 0; n < 60; ++n) {
        const Eigen::Vector2d noise = 0.3 * draws.Normals<2>();
        seen.observations.push_back({n, camera.Project(points[n] - Vector3d(0.02 * frame, 0, 0)) + noise});
      }
      odometry.Track(seen);
      double sigma = 0;
      for (const vo::MapPoint& point : odometry.Map()) {
        sigma += point.inverse_depth_sigma / 60;
        ASSERT_TRUE(point.moments);
        EXPECT_DOUBLE_EQ(point.relative_sigma, point.inverse_depth_sigma / point.inverse_depth);
      }
      if (frame == 1) {
        EXPECT_LT(sigma, 0.5 * before) << "lag " << lag;
      } else if (frame <= params.filter.start_window) {
        EXPECT_LT(sigma, 1.01 * before) << "lag " << lag << ", frame " << frame;
      } else {
        EXPECT_LT(std::abs(std::log(sigma / before)), std::log(3)) << "lag " << lag << ", frame " << frame;
      }
      before = sigma;
    }
  }
}

}  // namespace
