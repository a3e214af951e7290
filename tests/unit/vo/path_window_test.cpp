// Solver of delayed sampling against references that share none of its algebra.

#include "vo/filter/path_window.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_update.h"
#include "tests/unit/vo/propose.h"
#include "vo/filter/gauss_newton.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/path_gaussian.h"
#include "vo/filter/proposal.h"
#include "vo/filter/velocity_filter.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using vo::Matrix12;
using vo::Matrix6;
using vo::Vector6;
using vo_test::Draws;

// Window of frames at 30 Hz: landmarks anchored at the sampled start and at the window's first pose, seen from every
// later pose.
struct Scene {
  vo::Pose start;
  Vector6 velocity = Vector6::Zero();
  Matrix6 velocity_covariance = 0.04 * Matrix6::Identity();
  std::vector<vo::MotionModel> steps;
  std::vector<vo::Pose> truth;
  std::vector<vo::Landmark> landmarks;
  std::vector<vo::Pose> anchors;
  std::vector<vo::Track> tracks;
  vo::PathPrior prior() const { return {steps, velocity_covariance, {}}; }
  vo::WindowInput input() const { return {start, velocity, landmarks, anchors}; }
};

// way = 1: each view is from some millimetres beside its pose, as through a rolling shutter; 0: from the pose itself.
Scene MakeScene(unsigned seed, int frames, int count, double depth_sigma, double noise, double way = 1) {
  Draws draws(seed);
  Scene scene;
  scene.start = {Vector3d(0.3, -0.1, 0.2), vo::Exp({0.1, -0.2, 0.05})};
  scene.velocity << 0.1, -0.05, 0.08, 0.05, 0.1, -0.05;
  vo::Pose pose = scene.start;
  Vector6 velocity = scene.velocity + 0.2 * draws.Normals<6>();
  for (int k = 0; k < frames; ++k) {
    const double dt = (k % 2 == 0 ? 1.0 : 1.5) / 30;
    scene.steps.push_back(vo::NearlyConstantVelocity({.position_noise = 0.6, .orientation_noise = 0.4}, dt));
    velocity += 0.05 * draws.Normals<6>();
    pose = {pose.p_WC + velocity.head<3>() * dt, (pose.q_WC * vo::Exp(velocity.tail<3>() * dt)).normalized()};
    scene.truth.push_back(pose);
  }
  scene.anchors = {scene.start, vo::Pose{}};
  for (int n = 0; n < count; ++n) {
    const int anchor = frames > 1 ? n % 2 : 0;
    const vo::Pose& first = anchor == 0 ? scene.start : scene.truth[0];
    const Vector3d theta{1.2 * (draws.Uniform() - 0.5), 0.9 * (draws.Uniform() - 0.5),
                         0.3 + depth_sigma * draws.Normal()};
    vo::Landmark landmark;
    landmark.mean << theta.head<2>() + noise * draws.Normals<2>(), 0.3;
    landmark.covariance.diagonal() << noise * noise, noise * noise, depth_sigma * depth_sigma;
    scene.landmarks.push_back(landmark);
    vo::Track track{n, anchor, anchor == 0 ? -1 : 0, {}};
    for (int k = anchor; k < frames; ++k) {
      const Vector3d offset =
          way * Vector3d(0.005 * std::sin(n), 0.004 * std::cos(2 * n + k), 0.003 * std::sin(3 * n - k));
      const vo::Projection h = vo::Project(vo::AnchorView(scene.truth[k], first).ShiftedBy(offset), theta);
      track.views.push_back({k, h.z + noise * draws.Normals<2>(), Eigen::Matrix2d::Identity() / (noise * noise),
                             4 * std::log(noise), offset});
    }
    scene.tracks.push_back(track);
  }
  return scene;
}

vo::PathGaussian Solve(const Scene& scene, bool marginal, std::vector<Vector3d>* modes = nullptr, int iterations = 50) {
  vo::PathGaussian path;
  path.mean.assign(scene.truth.size(), scene.start);
  path.turns.assign(scene.truth.size(), {});
  std::vector<Vector3d> theta;
  for (const vo::Track& track : scene.tracks) theta.push_back(scene.landmarks[track.landmark].mean);
  vo::PathWindow().Solve(scene.prior(), scene.input(), scene.tracks, {iterations, marginal}, path, theta);
  if (modes) *modes = theta;
  return path;
}

double Distance(const vo::Pose& a, const vo::Pose& b, const Matrix6& covariance) {
  const Vector6 d = vo::Minus(a, b);
  return std::sqrt(d.dot(covariance.llt().solve(d)));
}

// Path of one pose against the proposal: each converges to the mode within kToleranceSigma. Their marginal modes
// evaluate curvature at points that differ in second order, and so do the covariances.
TEST(PathWindow, OfOnePoseIsTheProposal) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const bool marginal = seed % 2 == 0;
    const Scene scene = MakeScene(seed, 1, 60, 0.01, 0.2 / 525);
    const vo::PathGaussian path = Solve(scene, marginal);
    const vo::VelocityFilter step(scene.steps[0]);
    Vector6 start;
    start << scene.start.p_WC, Vector3d::Zero();
    const Vector6 s = step.PredictedMean(start, {scene.velocity, scene.velocity_covariance});
    Matrix6 J = Matrix6::Identity();
    J.bottomRightCorner<3, 3>() = vo::RightJacobian(s.tail<3>());
    const vo::PoseGaussian prediction{
        {s.head<3>(), scene.start.q_WC * vo::Exp(s.tail<3>())},
        J * step.PredictedCovariance({scene.velocity, scene.velocity_covariance}) * J.transpose()};
    std::vector<vo::Match> matches;
    std::vector<int> anchor_of(scene.landmarks.size(), 0);
    for (const vo::Track& track : scene.tracks)
      matches.push_back(
          {track.landmark, track.views[0].z, track.views[0].R_inverse.inverse(), track.views[0].centre_offset_W});
    const vo::PoseProposal one = vo_test::Propose(prediction, {scene.landmarks, anchor_of, scene.anchors}, matches,
                                                  {.max_iterations = 50, .marginal_mode = marginal});
    EXPECT_LT(Distance(path.mean[0], one.pose.mean, one.pose.covariance), 2 * vo::kToleranceSigma)
        << "standard deviations, seed " << seed;
    EXPECT_LT((path.covariance - one.pose.covariance).norm() / one.pose.covariance.norm(), marginal ? 2e-2 : 1e-3)
        << "seed " << seed;
    EXPECT_NEAR(path.log_evidence, one.log_evidence, 0.02)
        << "seed " << seed;  // coordinates of the prior differ at second order
  }
}

// Extension of a path by a pose without measurements: equal to the solution of the longer path.
TEST(PathEnd, AStepMoreIsAsIfSolvedAgain) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const int frames = static_cast<int>(seed % 6);
    Scene scene = MakeScene(seed, frames + 1, 40, 0.05, 0.2 / 525);
    for (vo::Track& track : scene.tracks)
      std::erase_if(track.views, [&](const vo::Track::View& view) { return view.slot == frames; });
    if (frames == 0) scene.tracks.clear();
    const vo::PathGaussian again = Solve(scene, false);
    const vo::MotionModel step = scene.steps.back();
    scene.steps.pop_back();
    scene.truth.pop_back();
    vo::PathGaussian path;
    if (frames > 0) path = Solve(scene, false);
    vo::Extend(scene.prior(), step, scene.start, scene.velocity, std::nullopt, path);
    ASSERT_EQ(path.mean.size(), again.mean.size());
    VectorXd off(again.covariance.rows());
    for (std::size_t k = 0; k < path.mean.size(); ++k)
      off.segment<6>(6 * static_cast<Eigen::Index>(k)) = vo::Minus(path.mean[k], again.mean[k]);
    EXPECT_LT(std::sqrt(off.dot(again.covariance.llt().solve(off))), 2 * vo::kToleranceSigma) << "seed " << seed;
    EXPECT_LT((path.covariance - again.covariance).norm(), 1e-3 * again.covariance.norm()) << "seed " << seed;
  }
}

// Steps with measured rotation: the means of their prior are those of extension step by step. Control: the motion model
// alone, whose mean differs.
TEST(PathEnd, AMeasuredTurnIsTheMeanOfItsStep) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene = MakeScene(seed, 5, 0, 0, 0);
    Draws draws(seed + 100);
    Matrix6 root;
    for (int column = 0; column < 6; ++column) root.col(column) = draws.Normals<6>();
    const vo::MotionInput correlated{.shape = Matrix6::Identity() + 0.1 * root * root.transpose()};
    scene.steps.clear();
    vo::PathGaussian path;
    for (int k = 0; k < 5; ++k) {
      const vo::MotionModel step =
          vo::NearlyConstantVelocity({.position_noise = 0.6, .orientation_noise = 0.4}, 1.0 / 30, correlated);
      const Eigen::Quaterniond turn = vo::Exp(0.2 * draws.Normals<3>());
      const bool measured = k % 2 == 1;
      vo::Extend(scene.prior(), step, scene.start, scene.velocity, measured ? std::optional(turn) : std::nullopt, path);
      scene.steps.push_back(step);
      if (!measured) continue;
      EXPECT_LT((path.mean[k - 1].q_WC * turn).angularDistance(path.mean[k].q_WC), 1e-12) << k;
    }
    const auto off = [&](std::vector<vo::StepTurn> turns) {
      vo::PathGaussian solved;
      solved.mean.assign(5, scene.start);
      solved.turns = std::move(turns);
      std::vector<Vector3d> theta;
      vo::PathWindow().Solve(scene.prior(), scene.input(), {}, {50, false}, solved, theta);
      double most = 0;  // standard deviations
      for (int k = 0; k < 5; ++k)
        most = std::max(most, Distance(solved.mean[k], path.mean[k], solved.covariance.block<6, 6>(6 * k, 6 * k)));
      return most;
    };
    EXPECT_LT(off(path.turns), 2 * vo::kToleranceSigma) << "seed " << seed;
    EXPECT_GT(off(std::vector<vo::StepTurn>(5)), 2) << "seed " << seed;
  }
}

// Conditioning on the scale: M P M', with the projector M that reduces the direction of the scale to a hundredth.
TEST(PathGaussian, GivenItsScale) {
  const Scene scene = MakeScene(5, 4, 0, 0.1, 1e-3);
  Draws draws(6);
  vo::PathGaussian path;
  path.mean = scene.truth;
  MatrixXd root(24, 24);
  for (int column = 0; column < 24; ++column)
    for (int block = 0; block < 4; ++block) root.block<6, 1>(6 * block, column) = draws.Normals<6>();
  const MatrixXd P = root * root.transpose() * 1e-4;
  path.covariance = P;
  vo::ConditionOnScale(scene.start, path);
  VectorXd d = VectorXd::Zero(24);
  for (int k = 0; k < 4; ++k) d.segment<3>(6 * k) = scene.truth[k].p_WC - scene.start.p_WC;
  const VectorXd information = P.inverse() * d;
  const MatrixXd M = MatrixXd::Identity(24, 24) - 0.99 / d.dot(information) * d * information.transpose();
  EXPECT_LT((path.covariance - M * P * M.transpose()).norm(), 1e-10 * P.norm());
  EXPECT_NEAR(d.dot(path.covariance.inverse() * d) / d.dot(information), 1e4, 1e-3);
}

// Two images at almost the same time, then none for seconds: the velocity between the two is multiplied by a step of
// many thousand times their interval.
TEST(PathEnd, IsSymmetricAfterAGap) {
  Scene scene = MakeScene(5, 4, 24, 0.05, 1.0 / 525);
  vo::PathGaussian path = Solve(scene, false);
  for (const double dt : {1e-5, 4.0}) {
    const vo::MotionModel step = vo::NearlyConstantVelocity({.position_noise = 0.6, .orientation_noise = 0.4}, dt);
    vo::Extend(scene.prior(), step, scene.start, scene.velocity, std::nullopt, path);
    scene.steps.push_back(step);
  }
  EXPECT_EQ(path.covariance, path.covariance.transpose());
  EXPECT_GT(path.covariance.diagonal().minCoeff(), 0);
}

// Evidence after iterations that end before convergence. The quadratic model of the last step is unverified; evidence
// that includes its predicted decrease would let a diverged particle outweigh all others.
TEST(PathWindow, EvidenceOfAnUnseenStep) {
  double worst = -1e300;
  int unsettled = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Scene scene = MakeScene(seed, 5, 40, 0.1, 0.2 / 525);
    Draws draws(seed + 1000);
    vo::PathGaussian path;
    std::vector<Vector3d> theta;
    for (const vo::Track& track : scene.tracks) theta.push_back(scene.landmarks[track.landmark].mean);
    path.turns.assign(scene.truth.size(), {});
    for (std::size_t k = 0; k < scene.truth.size(); ++k)
      path.mean.push_back(vo::Plus(scene.start, 0.1 * draws.Normals<6>()));
    for (const bool marginal : {false, true}) {
      vo::PathGaussian brief = path;
      std::vector<Vector3d> brief_theta = theta;
      vo::PathWindow().Solve(scene.prior(), scene.input(), scene.tracks, {3, marginal}, brief, brief_theta);
      vo::PathGaussian longer = brief;
      vo::PathWindow().Solve(scene.prior(), scene.input(), scene.tracks, {200, marginal}, longer, brief_theta);
      worst = std::max(worst, brief.log_evidence - longer.log_evidence);
      unsettled += std::abs(brief.log_evidence - longer.log_evidence) > 1;
    }
  }
  std::printf("%d of 400 unsettled; the most that one was too sure of itself: %.2f nats\n", unsettled, worst);
  EXPECT_GT(unsettled, 100);
  EXPECT_LT(worst, 1);
}

// Whitened residual r, |r|^2 = -2 log of the joint density of poses and landmarks up to a constant; scalar by scalar.
VectorXd Residual(const Scene& scene, const std::vector<vo::Pose>& poses, const std::vector<Vector3d>& theta) {
  const int m = static_cast<int>(poses.size());
  VectorXd u(6 * m);
  for (int k = 0; k < m; ++k) {
    const vo::Pose& from = k == 0 ? scene.start : poses[k - 1];
    u.segment<3>(6 * k) = poses[k].p_WC - from.p_WC;
    u.segment<3>(6 * k + 3) = vo::Log(from.q_WC.conjugate() * poses[k].q_WC);
  }
  // Covariance of the steps from unit noises propagated through the model.
  MatrixXd effect = MatrixXd::Zero(6 * m, 6 + 12 * m);  // of (v_0, noises)
  MatrixXd v = MatrixXd::Zero(6, 6 + 12 * m);
  v.leftCols<6>() = scene.velocity_covariance.llt().matrixL();
  VectorXd mean(6 * m);
  for (int k = 0; k < m; ++k) {
    const Matrix12 L = scene.steps[k].Q.llt().matrixL();
    const double dt = scene.steps[k].F(0, 6);
    effect.middleRows(6 * k, 6) = dt * v;
    effect.block(6 * k, 6 + 12 * k, 6, 12) += L.topRows<6>();
    v.middleCols(6 + 12 * k, 12) += L.bottomRows<6>();
    mean.segment<6>(6 * k) = dt * scene.velocity;
  }
  const MatrixXd covariance = effect * effect.transpose();
  const VectorXd r = covariance.llt().matrixL().solve(u - mean);
  std::vector<double> all(r.data(), r.data() + r.size());
  for (std::size_t n = 0; n < scene.tracks.size(); ++n) {
    const vo::Track& track = scene.tracks[n];
    const vo::Landmark& prior = scene.landmarks[track.landmark];
    for (int i = 0; i < 3; ++i) all.push_back((theta[n][i] - prior.mean[i]) / std::sqrt(prior.covariance(i, i)));
    const vo::Pose& anchor = track.anchor_slot < 0 ? scene.anchors[track.anchor] : poses[track.anchor_slot];
    for (const vo::Track::View& view : track.views) {
      const Vector3d ray(theta[n].x(), theta[n].y(), 1);
      const Vector3d X =
          poses[view.slot].q_WC.conjugate() *
          (anchor.q_WC * ray + theta[n].z() * (anchor.p_WC - poses[view.slot].p_WC - view.centre_offset_W));
      for (int i = 0; i < 2; ++i) all.push_back((X[i] / X.z() - view.z[i]) * std::sqrt(view.R_inverse(0, 0)));
    }
  }
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

void ExpectTheJointSolution(const Scene& scene, double left) {
  std::vector<Vector3d> theta;
  const vo::PathGaussian path = Solve(scene, false, &theta);
  const int m = 4, size = 6 * m + 3 * static_cast<int>(theta.size());
  MatrixXd J(Residual(scene, path.mean, theta).size(), size);
  constexpr double kStep = 1e-6;
  for (int j = 0; j < size; ++j) {
    VectorXd side[2];
    for (const int s : {0, 1}) {
      auto poses = path.mean;
      auto points = theta;
      const double h = s == 0 ? -kStep : kStep;
      if (j < 6 * m)
        poses[j / 6] = vo::Plus(poses[j / 6], h * Vector6::Unit(j % 6));
      else
        points[(j - 6 * m) / 3][(j - 6 * m) % 3] += h;
      side[s] = Residual(scene, poses, points);
    }
    J.col(j) = (side[1] - side[0]) / (2 * kStep);
  }
  const MatrixXd covariance = (J.transpose() * J).inverse();
  const VectorXd step = -covariance * (J.transpose() * Residual(scene, path.mean, theta));
  for (int i = 0; i < size; ++i)
    EXPECT_LT(std::abs(step[i]), left * std::sqrt(covariance(i, i))) << "at the joint mode, " << i;
  EXPECT_LT((path.covariance - covariance.topLeftCorner(6 * m, 6 * m)).norm() / path.covariance.norm(), 5e-3);
  // Joint covariance of each landmark and its anchor's pose, in units of the standard deviations.
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const vo::Track& track = scene.tracks[i];
    const int l = 6 * m + 3 * static_cast<int>(i), a = 6 * std::max(track.anchor_slot, 0);
    Eigen::Matrix<double, 9, 9> expected;
    expected << covariance.block<6, 6>(a, a), covariance.block<6, 3>(a, l), covariance.block<3, 6>(l, a),
        covariance.block<3, 3>(l, l);
    Eigen::Matrix<double, 9, 9> P = vo::LandmarkOnPath(scene.input(), track, path, theta[i]).WithAnchor();
    if (track.anchor_slot < 0) {
      EXPECT_EQ(P.topRows<6>().norm() + P.leftCols<6>().norm(), 0);
      P.topRows<6>() = expected.topRows<6>();
      P.leftCols<6>() = expected.leftCols<6>();
    }
    const Eigen::Matrix<double, 9, 1> scale = expected.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((scale.asDiagonal() * (P - expected) * scale.asDiagonal()).norm(), 5e-3) << "landmark " << i;
  }
}

// Elimination of the landmarks with a global shutter, and with a rolling one to the tolerance of Settled.
TEST(PathWindow, EliminatingLandmarksIsTheJointSolution) {
  ExpectTheJointSolution(MakeScene(5, 4, 24, 0.05, 1.0 / 525, 0), 5e-3);
  ExpectTheJointSolution(MakeScene(5, 4, 24, 0.05, 1.0 / 525), vo::kToleranceSigma);
}

// Another particle: start and anchor displaced by 3 mm, landmarks by 0.3 standard deviations, both times `spread`.
Scene Displaced(const Scene& scene, double spread) {
  Draws draws(11);
  Scene other = scene;
  other.start.p_WC += 3e-3 * spread * draws.Normals<3>();
  other.anchors[0] = other.start;
  for (vo::Landmark& landmark : other.landmarks)
    landmark.mean += 0.3 * spread * landmark.covariance.diagonal().cwiseSqrt().cwiseProduct(draws.Normals<3>());
  return other;
}

// Largest distances [standard deviations] from the particle's own solution: of the chord method's path, and of the
// linearised solution.
std::pair<double, double> ChordError(double spread) {
  const Scene scene = MakeScene(5, 4, 24, 0.05, 1.0 / 525, 0), other = Displaced(scene, spread);
  vo::PathWindow window;
  vo::PathGaussian solved;
  solved.mean.assign(4, scene.start);
  solved.turns.assign(4, {});
  std::vector<Vector3d> theta;
  for (const vo::Track& track : scene.tracks) theta.push_back(scene.landmarks[track.landmark].mean);
  window.Solve(scene.prior(), scene.input(), scene.tracks, {50, false, 1e-6}, solved, theta);
  vo::PathGaussian own = solved;
  std::vector<Vector3d> own_theta = theta;
  vo::PathWindow().Solve(other.prior(), other.input(), other.tracks, {50, false, 1e-6}, own, own_theta);
  vo::PathGaussian chord;
  chord.mean = solved.mean;
  chord.turns = solved.turns;
  EXPECT_TRUE(window.SolveAlike(other.prior(), other.input(), other.tracks, solved, chord, theta));
  EXPECT_NEAR(chord.log_evidence, own.log_evidence, spread);
  std::pair<double, double> error{0, 0};
  for (int k = 0; k < 4; ++k) {
    const Matrix6 P = own.covariance.block<6, 6>(6 * k, 6 * k);
    error.first = std::max(error.first, Distance(chord.mean[k], own.mean[k], P));
    error.second = std::max(error.second, Distance(solved.mean[k], own.mean[k], P));
  }
  return error;
}

// Error of the chord method, which converges where the kept Jacobians, not the particle's own, are orthogonal to the
// residuals: the change of the Jacobians times the residuals, a fraction of a standard deviation that falls with the
// distance of the particles.
TEST(ChordSolver, NearsTheOwnSolution) {
  double before = 0.3;
  for (const double spread : {1.0, 0.25, 0.0625}) {
    const auto [error, between] = ChordError(spread);
    std::printf("spread %.4f: %.4f of %.4f standard deviations\n", spread, error, between);
    EXPECT_LT(error, before);
    EXPECT_LT(error, between / 2);
    before = error / 3;
  }
}

// Predicted image of a track that is anchored in the window: independent of a drift common to all of the window, and of
// a symmetric covariance in spite of cancellation.
TEST(PathWindow, PredictsImagesAfterDrift) {
  const Scene scene = MakeScene(5, 4, 24, 0.05, 1.0 / 525, 0);
  std::vector<Vector3d> theta;
  const vo::PathGaussian path = Solve(scene, false, &theta);
  vo::PathGaussian drifted = path;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) drifted.covariance.block<3, 3>(6 * i, 6 * j) += 1e6 * Eigen::Matrix3d::Identity();
  int seen = 0;
  for (std::size_t i = 0; i < scene.tracks.size(); ++i) {
    const vo::Track& track = scene.tracks[i];
    const auto S_of = [&](const vo::PathGaussian& of) {
      const vo::LandmarkOnPath landmark(scene.input(), track, of, theta[i]);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, 24);
      const vo::LandmarkOnPath::Conditional given_path = landmark.GivenPath();
      const vo::Projection h = landmark.Image(given_path, J);
      Eigen::Matrix2d S = J * of.covariance * J.transpose() + h.J_landmark * given_path.P * h.J_landmark.transpose();
      return Eigen::Matrix2d(0.5 * (S + S.transpose()));
    };
    EXPECT_EQ(S_of(drifted)(0, 1), S_of(drifted)(1, 0));
    if (track.anchor_slot < 0) continue;
    EXPECT_LT((S_of(drifted) - S_of(path)).norm(), 1e-3 * S_of(path).norm());
    ++seen;
  }
  EXPECT_EQ(seen, 12);
}

// Prior of several steps against the velocity's Kalman filter, step by step: last velocity and log density.
TEST(PathPrior, LastVelocityIsTheVelocityFilters) {
  Draws draws(7);
  Scene scene = MakeScene(7, 6, 0, 0.05, 1);
  const vo::PathPrior prior = scene.prior();
  vo::VelocityFilter::State state{scene.velocity, scene.velocity_covariance};
  VectorXd off(36);
  double log_density = 0;
  for (int k = 0; k < 6; ++k) {
    const vo::VelocityFilter step(scene.steps[k]);
    const Vector6 u = 0.03 * draws.Normals<6>();
    const Vector6 nu = u - step.PredictedMean(Vector6::Zero(), state);
    const Matrix6 S = step.PredictedCovariance(state);
    log_density += -0.5 * nu.dot(S.inverse() * nu) - 0.5 * std::log(S.determinant());
    state = step.Condition(Vector6::Zero(), state).Given(u);
    off.segment<6>(6 * k) = u - prior.MeanStep(k, scene.velocity);
  }
  const Vector6 last = prior.LastMean(scene.velocity) + prior.gain() * off;
  EXPECT_LT((last - state.mean).norm() / state.mean.norm(), 1e-9);
  EXPECT_LT((prior.last_covariance() - state.covariance).norm() / state.covariance.norm(), 1e-9);
  EXPECT_NEAR(-0.5 * off.dot(prior.precision() * off) + 0.5 * prior.log_det_precision(), log_density,
              1e-6 * std::abs(log_density));
}

// p(z_1, z_2) = p(z_1) p(z_2 | z_1): factors of the window's evidence. With small noise the model is linear, and
// Laplace's approximation exact.
TEST(PathWindow, EvidenceOfTwoFramesFactors) {
  const Scene scene = MakeScene(9, 2, 30, 1e-4, 1e-5);
  Scene first = scene;
  for (vo::Track& track : first.tracks)
    std::erase_if(track.views, [](const vo::Track::View& view) { return view.slot == 1; });
  const vo::PathGaussian with = Solve(scene, false), without = Solve(first, false);
  // p(z_2 | z_1) = p(s_1 | z_1) p(z_2 | s_1, z_1) / p(s_1 | z_1, z_2) at any s_1, here drawn from p(s_1 | z_1, z_2).
  Draws draws(11);
  for (int draw = 0; draw < 3; ++draw) {
    const Matrix6 P = with.covariance.topLeftCorner<6, 6>();
    const vo::Pose s = vo::Plus(with.mean[0], P.llt().matrixL() * draws.Normals<6>());
    Scene second = scene;
    second.start = s;
    second.anchors[1] = s;
    const vo::VelocityFilter step(scene.steps[0]);
    Vector6 from, to;
    from << scene.start.p_WC, Vector3d::Zero();
    to << s.p_WC, vo::Log(scene.start.q_WC.conjugate() * s.q_WC);
    const auto state = step.Condition(from, {scene.velocity, scene.velocity_covariance}).Given(to);
    second.velocity = state.mean;
    second.velocity_covariance = state.covariance;
    second.steps.erase(second.steps.begin());
    second.truth.erase(second.truth.begin());
    for (vo::Track& track : second.tracks) {
      vo::Landmark& landmark = second.landmarks[track.landmark];
      for (const vo::Track::View& view : track.views)
        if (view.slot == 0)
          landmark =
              vo_test::UpdateLandmark(landmark, landmark.mean,
                                      vo::AnchorView(s, scene.anchors[track.anchor]).ShiftedBy(view.centre_offset_W),
                                      {track.landmark, view.z, view.R_inverse.inverse()}, 10)
                  .landmark;
      std::erase_if(track.views, [](const vo::Track::View& view) { return view.slot == 0; });
      track.views[0].slot = 0;
      track.anchor_slot = -1;
    }
    const double second_given_s = Solve(second, false).log_evidence;
    const vo::PoseGaussian first_only{without.mean[0], without.covariance.topLeftCorner<6, 6>()}, both{with.mean[0], P};
    const double increment = first_only.LogDensity(s) + second_given_s - both.LogDensity(s);
    EXPECT_NEAR(with.log_evidence - without.log_evidence, increment, 2e-3) << "of " << increment;
  }
}

// Scale bias with many landmarks of unknown depth and a step that is short relative to the noise: the joint mode
// stretches the step, the marginal mode does not.
TEST(PathWindow, TheMarginalsModeIsNotBiasedInScale) {
  double joint = 0, marginal = 0, length = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Scene scene = MakeScene(100 + seed, 6, 100, 0.015, 1.0 / 525);
    const Vector3d t = scene.truth.back().p_WC - scene.start.p_WC;
    joint += (Solve(scene, false).mean.back().p_WC - scene.start.p_WC).dot(t) / t.norm();
    marginal += (Solve(scene, true).mean.back().p_WC - scene.start.p_WC).dot(t) / t.norm();
    length += t.norm();
  }
  EXPECT_NEAR(marginal / length, 1.0, 0.05);
  EXPECT_GT(std::abs(joint / length - 1.0), 2 * std::abs(marginal / length - 1.0))
      << joint / length << " " << marginal / length;
}

}  // namespace
