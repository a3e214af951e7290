// EKF-SLAM: agreement with the dense batch solution, and consistency of its covariance.

#include "vo/filter/ekf_slam.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "vo/filter/motion_model.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector12 = Eigen::Matrix<double, 12, 1>;

struct State {
  vo::Pose pose;
  vo::Vector6 velocity = vo::Vector6::Zero();
};

// Noise in the coordinates of the model (6)-(9): position, rotation of the step, velocities.
State Step(const State& from, const Vector12& noise, double dt) {
  const vo::Vector6 u = from.velocity * dt + noise.head<6>();
  return {{from.pose.p_WC + u.head<3>(), from.pose.q_WC * vo::Exp(u.tail<3>())}, from.velocity + noise.tail<6>()};
}
Vector12 StepNoise(const State& from, const State& to, double dt) {
  Vector12 noise;
  noise << vo::Minus(to.pose, from.pose) - from.velocity * dt, to.velocity - from.velocity;
  return noise;
}

// World drawn from the filter's prior: motion, landmarks about the mean inverse depth, pixel noise.
struct World {
  vo::MotionParams motion{.position_noise = 0.5, .orientation_noise = 0.3};
  vo::LandmarkParams landmark{.inverse_depth = 0.25, .inverse_depth_sigma = 0.0125};
  vo::FilterPrior prior;
  double sigma = 1.0 / 525;
  std::vector<double> dt;  // before each frame but the first
  std::vector<State> truth;
  struct Point {
    int born = 0;    // frame of the first view
    Vector2d ray;    // as seen there
    Vector3d theta;  // true (x, y, rho)
  };
  std::vector<Point> points;
  std::vector<std::vector<vo::Match>> matches;  // per frame
};

// `born`: number of new landmarks in each frame.
World Draw(std::uint64_t seed, const std::vector<int>& born, double scale = 1, bool fixed = false) {
  World world;
  world.sigma *= scale;
  world.motion.position_noise *= scale;
  world.motion.orientation_noise *= scale;
  world.landmark.inverse_depth_sigma *= scale;
  if (fixed) world.landmark.bearing = vo::Bearing::fixed;
  std::uint32_t d = 0;
  const auto draw = [&] { return vo::Normal({.seed = seed, .stream = static_cast<vo::Stream>(6)}, d++); };
  world.prior.velocity << 0.3, -0.1, 0.1, 0.05, 0.1, -0.05;
  world.prior.velocity_covariance = 0.01 * scale * scale * vo::Matrix6::Identity();
  world.prior.pose.covariance = 1e-4 * scale * scale * vo::Matrix6::Identity();
  State state{world.prior.pose.Sample({.seed = seed, .stream = vo::Stream::prior_pose}), world.prior.velocity};
  for (double& v : state.velocity) v += 0.1 * scale * draw();
  const Matrix2d R = world.sigma * world.sigma * Matrix2d::Identity();
  for (std::size_t k = 0; k < born.size(); ++k) {
    if (k > 0) {
      world.dt.push_back(k % 3 == 2 ? 0.05 : 1.0 / 30);
      const vo::MotionModel model = vo::NearlyConstantVelocity(world.motion, world.dt.back());
      Vector12 noise;
      for (double& x : noise) x = draw();
      state = Step(state, model.Q.llt().matrixL() * noise, world.dt.back());
    }
    world.truth.push_back(state);
    auto& matches = world.matches.emplace_back();
    for (std::size_t n = 0; n < world.points.size(); ++n) {
      const World::Point& point = world.points[n];
      const vo::Pose& anchor = world.truth[static_cast<std::size_t>(point.born)].pose;
      const Vector3d X = state.pose.q_WC.conjugate() *
                         (anchor.p_WC + anchor.q_WC * Vector3d(point.theta.x(), point.theta.y(), 1) / point.theta.z() -
                          state.pose.p_WC);
      matches.push_back({static_cast<int>(n), X.head<2>() / X.z() + world.sigma * Vector2d{draw(), draw()}, R});
    }
    for (int i = 0; i < born[k]; ++i) {
      const double angle = 2.4 * static_cast<double>(world.points.size());
      World::Point point{static_cast<int>(k), Vector2d(0.5 * std::cos(angle), 0.4 * std::sin(1.3 * angle)), {}};
      point.theta << point.ray, world.landmark.inverse_depth + world.landmark.inverse_depth_sigma * draw();
      if (!fixed) point.theta.head<2>() -= world.sigma * Vector2d{draw(), draw()};
      world.points.push_back(point);
    }
  }
  return world;
}

vo::EkfSlam RunOn(const World& world, int iterations,
                  const std::function<void(std::size_t, const vo::EkfSlam&)>& look = {}) {
  vo::EkfSlam filter(world.motion, {.joint_iterations = iterations}, world.landmark, world.prior);
  for (std::size_t k = 0; k < world.truth.size(); ++k) {
    if (k > 0) {
      filter.Predict(world.dt[k - 1]);
      filter.Update(world.matches[k]);
    }
    if (look) look(k, filter);
    std::vector<vo::FirstView> views;
    for (const World::Point& point : world.points)
      if (point.born == static_cast<int>(k))
        views.push_back({point.ray, world.sigma * world.sigma * Matrix2d::Identity()});
    filter.AddLandmarks(views);
  }
  return filter;
}

// Batch solution: dense least squares over the states of all frames and all landmarks, with numeric Jacobians.
struct Batch {
  State last;
  vo::Matrix12 covariance;
};
Batch SolveBatch(const World& world) {
  const int frames = static_cast<int>(world.truth.size()), points = static_cast<int>(world.points.size());
  std::vector<State> states = world.truth;
  std::vector<Vector3d> thetas;
  for (const World::Point& point : world.points) thetas.push_back(point.theta);
  const auto moved = [](const State& s, const Vector12& d) {
    return State{vo::Plus(s.pose, d.head<6>()), s.velocity + d.tail<6>()};
  };
  const auto residual = [&](const VectorXd& d) {
    std::vector<double> r;
    const auto add = [&](const VectorXd& v) { r.insert(r.end(), v.begin(), v.end()); };
    std::vector<State> s;
    for (int k = 0; k < frames; ++k) s.push_back(moved(states[k], d.segment<12>(12 * k)));
    add(world.prior.pose.covariance.llt().matrixL().solve(vo::Minus(s[0].pose, world.prior.pose.mean)));
    add(world.prior.velocity_covariance.llt().matrixL().solve(s[0].velocity - world.prior.velocity));
    for (int k = 1; k < frames; ++k)
      add(vo::NearlyConstantVelocity(world.motion, world.dt[k - 1])
              .Q.llt()
              .matrixL()
              .solve(StepNoise(s[k - 1], s[k], world.dt[k - 1])));
    for (int n = 0; n < points; ++n) {
      const Vector3d theta = thetas[n] + d.segment<3>(12 * frames + 3 * n);
      add((theta.head<2>() - world.points[n].ray) / world.sigma);
      add(VectorXd::Constant(1, (theta.z() - world.landmark.inverse_depth) / world.landmark.inverse_depth_sigma));
      for (int k = world.points[n].born + 1; k < frames; ++k) {
        const vo::Projection h = vo::Project({s[k].pose, s[world.points[n].born].pose}, theta);
        add((h.z - world.matches[k][n].z) / world.sigma);
      }
    }
    return VectorXd(Eigen::Map<VectorXd>(r.data(), static_cast<Eigen::Index>(r.size())));
  };
  const int size = 12 * frames + 3 * points;
  MatrixXd J;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const VectorXd r = residual(VectorXd::Zero(size));
    J.resize(r.size(), size);
    for (int i = 0; i < size; ++i) {
      const double h = 1e-7;
      J.col(i) = (residual(h * VectorXd::Unit(size, i)) - residual(-h * VectorXd::Unit(size, i))) / (2 * h);
    }
    const VectorXd step = -J.householderQr().solve(r);
    for (int k = 0; k < frames; ++k) states[k] = moved(states[k], step.segment<12>(12 * k));
    for (int n = 0; n < points; ++n) thetas[n] += step.segment<3>(12 * frames + 3 * n);
  }
  const MatrixXd covariance = (J.transpose() * J).inverse();
  return {states.back(), covariance.block<12, 12>(12 * (frames - 1), 12 * (frames - 1))};
}

// Noise a hundredth of the usual: the problem is linear within its own uncertainty, where the filter is exact.
TEST(EkfSlam, EqualsTheDenseBatchSolutionWhereLinear) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const World world = Draw(seed, {6, 0, 3, 0, 0}, 0.01);
    const Batch batch = SolveBatch(world);
    const vo::EkfSlam filter = RunOn(world, 10);
    const vo::Belief& belief = filter.belief();
    Vector12 off;
    off << vo::Minus(belief.pose, batch.last.pose), belief.velocity - batch.last.velocity;
    const MatrixXd L = batch.covariance.llt().matrixL();
    EXPECT_LT((L.inverse() * off).norm(), 0.02) << seed;  // standard deviations
    EXPECT_LT((L.inverse() * (belief.covariance - batch.covariance) * L.inverse().transpose()).norm(), 0.02) << seed;
  }
}

// Iterated update over two frames, far from linear in depth: Gauss-Newton on all variables, to the mode of the batch.
TEST(EkfSlam, IteratedUpdateIsTheJointMode) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    World world = Draw(seed, {12, 0}, 1);
    world.landmark.inverse_depth_sigma = 0.15;
    world.prior.velocity_covariance *= 4;
    const Batch batch = SolveBatch(world);
    const auto off = [&](int iterations) {
      const vo::Belief belief = RunOn(world, iterations).belief();
      Vector12 d;
      d << vo::Minus(belief.pose, batch.last.pose), belief.velocity - batch.last.velocity;
      return d.cwiseQuotient(batch.covariance.diagonal().cwiseSqrt()).norm();
    };
    EXPECT_LT(off(200), 0.02) << "standard deviations, seed " << seed;
    EXPECT_GT(off(1), 0.2) << "seed " << seed;
  }
}

// Wilson-Hilferty normal score of the joint NEES of the last frame, in worlds drawn from the filter's prior: chi-square
// with 12 degrees of freedom per run. False-alarm rate 1e-3 at 3.3. `claimed`: factor on the covariance.
double Score(int runs, double claimed, int iterations = 1) {
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    const World world = Draw(100 + static_cast<std::uint64_t>(run), {15, 0, 0, 5, 0, 0, 3, 0, 0, 0});
    const vo::EkfSlam filter = RunOn(world, iterations);
    const vo::Belief& belief = filter.belief();
    Vector12 e;
    e << vo::Minus(world.truth.back().pose, belief.pose), world.truth.back().velocity - belief.velocity;
    sum += e.dot((claimed * belief.covariance).ldlt().solve(e));
  }
  const double k = 12.0 * runs;
  return (std::cbrt(sum / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

TEST(EkfSlam, ConsistentInAWorldOfItsPrior) {
  EXPECT_LT(std::abs(Score(100, 1)), 3.3);
  EXPECT_GT(Score(100, 0.5), 3.3);
  EXPECT_LT(Score(100, 2), -3.3);
  EXPECT_GT(Score(100, 1, 10), 3.3) << "the joint mode is biased";
}

TEST(EkfSlam, CovarianceStaysSymmetricAndPositive) {
  for (const bool fixed : {false, true}) {
    const World world = Draw(9, {20, 0, 2, 0, 2, 0, 0, 0, 0, 0}, 1, fixed);
    RunOn(world, 10, [&](std::size_t k, const vo::EkfSlam& filter) {
      const MatrixXd& P = filter.covariance();
      ASSERT_TRUE(P.allFinite());
      EXPECT_EQ((P - P.transpose()).norm(), 0) << k;
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(P).eigenvalues().minCoeff(), -1e-12 * P.norm()) << k;
    });
  }
}

TEST(EkfSlam, PredictAgainLeavesNoTrace) {
  World world = Draw(3, {10, 0, 0});
  vo::EkfSlam once = RunOn(world, 10), twice = once;
  once.Predict(0.1, {7, 5});
  twice.Predict(0.1);
  twice.PredictAgain({30, 2});
  twice.PredictAgain({7, 5});
  EXPECT_EQ(once.covariance(), twice.covariance());
  EXPECT_EQ(once.Reference().prediction.covariance, twice.Reference().prediction.covariance);
  EXPECT_EQ(once.Reference().prediction.mean.p_WC, twice.Reference().prediction.mean.p_WC);
}

TEST(EkfSlam, CoastsInOneStepAsInTwo) {
  World world = Draw(3, {10, 0, 0});
  vo::EkfSlam one = RunOn(world, 10), two = one;
  one.Predict(0.1);
  one.Update({});
  two.Predict(0.04);
  two.Update({});
  two.Predict(0.06);
  two.Update({});
  EXPECT_LT(vo::Minus(one.belief().pose, two.belief().pose).norm(), 1e-12);
  EXPECT_LT((one.belief().covariance - two.belief().covariance).norm(), 1e-3 * one.belief().covariance.norm());
  EXPECT_GT(one.belief().covariance.trace(), RunOn(world, 10).belief().covariance.trace());
}

// Removal of a landmark as marginalisation: all else is unchanged, and an anchor is removed with its last landmark.
TEST(EkfSlam, DroppedLandmarksLeaveTheRestAlone) {
  const World world = Draw(7, {6, 0, 4, 0, 0});
  vo::EkfSlam filter = RunOn(world, 10);
  ASSERT_EQ(filter.covariance().rows(), 12 + 2 * 6 + 10 * 3);
  const vo::Belief before = filter.belief();
  std::vector<vo::ImagePrediction> predictions;
  for (int n = 0; n < 10; ++n) predictions.push_back(filter.PredictImages(std::array{n})[0]);
  const std::vector<bool> keep = {false, true, false, true, true, true, false, false, true, true};
  filter.KeepLandmarks(keep);
  EXPECT_EQ(filter.covariance().rows(), 12 + 2 * 6 + 6 * 3);
  EXPECT_EQ(filter.covariance().topLeftCorner(12, 12), before.covariance);
  for (int n = 0, kept = 0; n < 10; ++n) {
    if (!keep[static_cast<std::size_t>(n)]) continue;
    const vo::ImagePrediction now = filter.PredictImages(std::array{kept++})[0];
    EXPECT_EQ(now.z, predictions[static_cast<std::size_t>(n)].z);
    EXPECT_EQ(now.covariance, predictions[static_cast<std::size_t>(n)].covariance);
  }
  filter.KeepLandmarks({false, false, false, false, true, true});
  EXPECT_EQ(filter.covariance().rows(), 12 + 6 + 2 * 3);
  filter.KeepLandmarks({false, false});
  EXPECT_EQ(filter.covariance().rows(), 12);
  filter.Predict(0.1);
  filter.Update({});
  filter.AddLandmarks(std::vector<vo::FirstView>{{{0, 0}, Matrix2d::Identity()}});
  EXPECT_EQ(filter.covariance().rows(), 12 + 6 + 3);
}

// nu' (P + R)^-1 nu of innovations over independent worlds, P of PredictImages: chi-square, 2 degrees of freedom each.
TEST(EkfSlam, PredictedImagesAreConsistent) {
  double sum = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const World world = Draw(seed + 500, {6, 0, 0, 0});
    vo::EkfSlam filter = RunOn({world.motion,
                                world.landmark,
                                world.prior,
                                world.sigma,
                                {world.dt[0], world.dt[1]},
                                {world.truth[0], world.truth[1], world.truth[2]},
                                world.points,
                                {world.matches[0], world.matches[1], world.matches[2]}},
                               1);
    filter.Predict(world.dt[2]);
    const vo::Match& match = world.matches[3][seed % 6];
    const vo::ImagePrediction prediction = filter.PredictImages(std::array{match.landmark})[0];
    const Vector2d nu = match.z - prediction.z;
    sum += nu.dot(Matrix2d(prediction.covariance + match.R).inverse() * nu);
    count += 2;
  }
  EXPECT_NEAR(sum / count, 1, 3.3 * std::sqrt(2.0 / count));  // false-alarm rate 1e-3
}

}  // namespace
