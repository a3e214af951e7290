// Angular rates of rows in a window, for a camera whose rate differs from frame to frame.
// Reference: exact images of landmarks, poses and rates drawn from the model.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/path_window.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using vo::Matrix6;
using vo::Vector6;

constexpr int kFrames = 4, kLandmarks = 40, kWorlds = 200;
constexpr double kReadout = 0.026, kSigma = 0.3 / 525, kDepthSigma = 0.01;

// N(0, precision^-1)
VectorXd Drawn(const Eigen::MatrixXd& precision, vo_test::Draws& draws) {
  VectorXd normals(precision.rows());
  for (double& n : normals) n = draws.Normal();
  return precision.llt().matrixU().solve(normals);
}

TEST(RowRates, JacobianIsThatOfTheCompensation) {
  constexpr double kStep = 1e-6;
  const vo::RowView row{{0.3, -0.4}, 0.011};
  const vo::Matrix23 J = vo::RateJacobian(row);
  for (int axis = 0; axis < 3; ++axis) {
    Vector6 rate = Vector6::Zero();
    rate(3 + axis) = kStep;
    const Eigen::Vector2d slope = (row.RotationCompensated(rate).z - row.RotationCompensated(-rate).z) / (2 * kStep);
    EXPECT_LT((slope + J.col(axis)).norm(), 1e-9) << axis;  // J is of the raw measurement
  }
}

// NEES of the path per degree of freedom; landmarks are first seen from the start and from the first pose, half each.
double Nees(unsigned world, vo::Rates rates) {
  vo_test::Draws draws(world);
  const std::vector<vo::MotionModel> steps(
      kFrames, vo::NearlyConstantVelocity({.position_noise = 0.6, .orientation_noise = 2}, 1.0 / 30));
  const vo::PathPrior prior(steps, 0.01 * Matrix6::Identity(), steps);
  const vo::Pose start{Vector3d(0.3, -0.1, 0.2), vo::Exp({0.1, -0.2, 0.05})};
  Vector6 velocity;
  velocity << 0.3, -0.1, 0.1, 0.1, 0.2, -0.1;
  const VectorXd noise = Drawn(prior.precision(), draws), rate = Drawn(prior.rate_precision(), draws);
  std::vector<vo::Pose> truth;
  for (int k = 0; k < kFrames; ++k)
    truth.push_back(
        vo::Plus(k == 0 ? start : truth.back(), prior.MeanStep(k, velocity) + noise.segment<6>(vo::kPoseSize * k)));
  // Pose of the camera at a row's time in a frame; -1: the start.
  const auto camera = [&](int frame, double time) {
    vo::Pose pose = frame < 0 ? start : truth[frame];
    pose.q_WC = pose.q_WC * vo::Exp(time * rate.segment<3>(3 * (frame + 1)));
    return pose;
  };
  std::vector<vo::Landmark> landmarks;
  std::vector<vo::FirstView> first_views;
  std::vector<vo::Track> tracks;
  std::vector<Vector3d> theta;
  for (int n = 0; n < kLandmarks; ++n) {
    const int anchor = n % 2 - 1;
    const double y = 0.9 * (draws.Uniform() - 0.5), rho = 0.3 + kDepthSigma * draws.Normal();
    const Vector3d ray(1.2 * (draws.Uniform() - 0.5), y, rho);
    const double time = kReadout * y / 0.9;
    const vo::Pose first = camera(anchor, time);
    const Eigen::Vector2d seen = ray.head<2>() + kSigma * draws.Normals<2>();
    vo::FirstView view{seen, kSigma * kSigma * Eigen::Matrix2d::Identity()};
    view.row = {seen, time};
    first_views.push_back(view);
    landmarks.push_back({{seen.x(), seen.y(), 0.3},
                         Vector3d(kSigma * kSigma, kSigma * kSigma, kDepthSigma * kDepthSigma).asDiagonal()});
    vo::Track track{n, anchor + 1, anchor, {}};
    for (int k = anchor + 1; k < kFrames; ++k) {
      double row_time = time;
      Eigen::Vector2d z;
      for (int i = 0; i < 5; ++i) {
        z = vo::Project({camera(k, row_time), first}, ray).z;
        row_time = kReadout * z.y() / 0.9;
      }
      track.views.push_back({k, z + kSigma * draws.Normals<2>(), Eigen::Matrix2d::Identity() / (kSigma * kSigma),
                             4 * std::log(kSigma), Vector3d::Zero(), row_time});
    }
    tracks.push_back(track);
    theta.push_back(landmarks.back().mean);
  }
  const std::vector<vo::Pose> anchors = {start, truth[0]};
  vo::PathGaussian path;
  path.mean.assign(kFrames, start);
  path.turns.assign(kFrames, {});
  path.rates.assign(kFrames + 1, Vector3d::Zero());
  vo::WindowOptions options{50};
  options.rates = rates;
  vo::PathWindow().Solve(prior, {start, velocity, landmarks, anchors, first_views}, tracks, options, path, theta);
  if (rates == vo::Rates::with_start) {
    EXPECT_EQ(path.events.not_converged, 0) << world;
  }
  VectorXd error(vo::kPoseSize * kFrames);
  for (int k = 0; k < kFrames; ++k) error.segment<6>(vo::kPoseSize * k) = vo::Minus(truth[k], path.mean[k]);
  return error.dot(path.covariance.llt().solve(error)) / (vo::kPoseSize * kFrames);
}

// Mean NEES over 200 worlds of 24 degrees of freedom: standard deviation 0.02, bounds of 3.3 of these, false-alarm rate
// 1e-3. Controls: without rates; with those of the window, but not the start's.
TEST(RowRates, LeaveThePathConsistent) {
  double with_start = 0, of_window = 0, none = 0;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    with_start += Nees(world, vo::Rates::with_start) / kWorlds;
    of_window += Nees(world, vo::Rates::of_window) / kWorlds;
    none += Nees(world, vo::Rates::none) / kWorlds;
  }
  EXPECT_NEAR(with_start, 1, 0.067);
  EXPECT_GT(of_window, 1.2);
  EXPECT_GT(none, 2);
  std::printf("NEES per degree of freedom: with the start's rate %.3f, without %.2f, without rates %.2f\n", with_start,
              of_window, none);
}

}  // namespace
