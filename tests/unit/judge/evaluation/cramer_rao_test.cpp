// Linearised Cramer-Rao bound against the inverse of the dense information matrix of the whole problem in anchored form
// (the recursion uses another), and against closed forms.
#include "tools/judge/evaluation/cramer_rao.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <chrono>
#include <cmath>

#include "tests/unit/judge/evaluation/point_world.h"
#include "tools/judge/evaluation/anees_test.h"
#include "tools/judge/evaluation/mixture_scores.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using Eigen::MatrixXd;

using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// Covariance of the last frame's state, from the information matrix of all states and all landmarks (x, y, rho), with
// views in anchored form.
Matrix12d BatchBound(const PointWorldProblem& problem, std::size_t last) {
  const Eigen::Index frames = static_cast<Eigen::Index>(last) + 1;
  const Eigen::Index n = 12 * frames + 3 * static_cast<Eigen::Index>(problem.landmarks.size());
  Wide information = Wide::Zero(n, n);
  const auto add = [&](const MatrixXd& J, const MatrixXd& covariance) {  // J: rows x n
    std::vector<Eigen::Index> used;
    for (Eigen::Index c = 0; c < n; ++c)
      if (!J.col(c).isZero(0)) used.push_back(c);
    const Wide wide = J(Eigen::all, used).cast<long double>();
    const Wide inverse = covariance.cast<long double>().inverse();
    information(used, used) += wide.transpose() * inverse * wide;
  };
  MatrixXd start = MatrixXd::Zero(12, n);
  start.leftCols(12).setIdentity();
  add(start, problem.start_covariance);
  for (Eigen::Index k = 1; k < frames; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const MotionJacobian motion =
        LinearisedMotion(problem.truth[i - 1], problem.truth[i], problem.position_noise, problem.orientation_noise);
    MatrixXd J = MatrixXd::Zero(12, n);
    J.middleCols(12 * k, 12).setIdentity();
    J.middleCols(12 * (k - 1), 12) = -motion.F;
    add(J, motion.Q);
  }
  for (std::size_t l = 0; l < problem.landmarks.size(); ++l) {
    const PointLandmark& landmark = problem.landmarks[l];
    const Eigen::Index at = 12 * frames + 3 * static_cast<Eigen::Index>(l);
    MatrixXd prior = MatrixXd::Zero(3, n);
    prior.middleCols(at, 3).setIdentity();
    const Eigen::Vector3d sigma(problem.anchor_sigma, problem.anchor_sigma, landmark.inverse_depth_sigma);
    add(prior, sigma.cwiseAbs2().asDiagonal());
    if (landmark.anchor_frame > last) continue;
    const StampedPose& anchor = problem.truth[landmark.anchor_frame];
    const Eigen::Matrix3d R_a = anchor.q_WC.toRotationMatrix();
    const Eigen::Vector3d ray(landmark.ray[0], landmark.ray[1], 1);
    for (const std::size_t k : landmark.frames) {
      if (k > last) break;
      const StampedPose& pose = problem.truth[k];
      const Eigen::Matrix3d R = pose.q_WC.toRotationMatrix().transpose();
      const Eigen::Vector3d X = R * (landmark.inverse_depth * (anchor.p_WC - pose.p_WC) + R_a * ray);
      Eigen::Matrix<double, 2, 3> D;
      D << 1 / X.z(), 0, -X.x() / (X.z() * X.z()), 0, 1 / X.z(), -X.y() / (X.z() * X.z());
      MatrixXd J = MatrixXd::Zero(2, n);
      const Eigen::Index here = 12 * static_cast<Eigen::Index>(k),
                         there = 12 * static_cast<Eigen::Index>(landmark.anchor_frame);
      J.middleCols(here, 3) = -landmark.inverse_depth * D * R;
      J.middleCols(there, 3) = landmark.inverse_depth * D * R;
      for (int i = 0; i < 3; ++i) {
        J.col(here + 3 + i) = D * X.cross(Eigen::Vector3d::Unit(i));
        J.col(there + 3 + i) = -D * R * R_a * ray.cross(Eigen::Vector3d::Unit(i));
      }
      J.middleCols(at, 2) = D * R * R_a.leftCols<2>();
      J.col(at + 2) = D * R * (anchor.p_WC - pose.p_WC);
      add(J, problem.sigma * problem.sigma * MatrixXd::Identity(2, 2));
    }
  }
  const Wide root = information.diagonal().cwiseSqrt().cwiseInverse();
  const auto scale = root.col(0).asDiagonal();
  Wide columns = Wide::Zero(n, 12);  // of the covariance, which is scale (scale information scale)^-1 scale
  columns.middleRows(12 * (frames - 1), 12).setIdentity();
  columns = scale * Wide(scale * information * scale).llt().solve(Wide(scale * columns));
  return columns.middleRows(12 * (frames - 1), 12).cast<double>();
}

// Largest difference in units of the standard deviations.
double Difference(const Matrix12d& a, const Matrix12d& b) {
  const Vector12d w = b.diagonal().cwiseSqrt().cwiseInverse();
  return (w.asDiagonal() * (a - b) * w.asDiagonal()).cwiseAbs().maxCoeff();
}

// Nine frames: interrupted tracks, a second anchor, a track that ends early, a point never seen again, an uneven step.
PointWorldProblem InterruptedWorld() {
  TestRandom random(83);
  PointWorldProblem problem = MakePointWorld(random, 9, 7, 3);
  problem.landmarks[2].inverse_depth_sigma = 0.01;
  problem.landmarks[0].frames = {1, 2, 6};
  problem.landmarks[1].frames = {3};
  problem.landmarks[3].frames.clear();
  problem.landmarks[4].anchor_frame = 2;
  problem.landmarks[4].frames = {4, 5, 8};
  problem.landmarks[5].inverse_depth = 0;
  for (std::size_t k = 5; k < 9; ++k) problem.truth[k].stamp_ns += 20'000'000;
  return problem;
}

TEST(LinearisedBound, IsTheInverseOfTheWholeInformation) {
  PointWorldProblem problem = InterruptedWorld();
  const auto bound = SimulateLinearised(problem, 0).bound;
  ASSERT_EQ(bound.size(), 9u);
  double worst = 0;
  for (std::size_t k = 0; k < 9; ++k) worst = std::max(worst, Difference(bound[k], BatchBound(problem, k)));
  RecordProperty("worst_1e12", std::to_string(1e12 * worst));
  EXPECT_LT(worst, 1e-9);
  // Control: a sigma 1 % larger (a hundredth of a pixel) is detected.
  problem.sigma *= 1.01;
  EXPECT_GT(Difference(bound[8], BatchBound(problem, 8)), 1e-4);
}

// Closed form: a stationary camera of known orientation and constant unknown velocity, one point straight ahead of
// known inverse depth. The x of the view at t is x_0 - rho v t + noise: linear regression with known intercept, or with
// one known up to the noise of the first view.
TEST(LinearisedBound, OfAConstantVelocityIsALinearRegression) {
  const double rho = 0.25, sigma = 2e-3, P0 = 1e-4, V0 = 0.04;
  for (const double anchor_sigma : {0.0, 3e-3}) {
    PointWorldProblem problem;
    problem.position_noise = problem.orientation_noise = 0;
    problem.sigma = sigma;
    problem.anchor_sigma = anchor_sigma;
    problem.start_covariance(0, 0) = P0;
    problem.start_covariance(6, 6) = V0;
    PointLandmark landmark;
    landmark.inverse_depth = rho;
    landmark.inverse_depth_sigma = 0.15;  // no information without motion
    double tt = 0, t1 = 0, count = 0;
    for (std::size_t k = 0; k < 50; ++k) {
      problem.truth.push_back(
          {static_cast<std::int64_t>(k) * 33'333'333, Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond::Identity()});
      if (k > 0) landmark.frames.push_back(k);
    }
    problem.landmarks = {landmark};
    const auto bound = SimulateLinearised(problem, 0).bound;
    for (std::size_t k = 1; k < 50; ++k) {
      const double t = static_cast<double>(k) * 0.033333333;
      tt += rho * rho * t * t / (sigma * sigma);
      t1 += rho * t / (sigma * sigma);
      count += 1 / (sigma * sigma);
      double information = 1 / V0 + tt;  // of v
      if (anchor_sigma > 0) information -= t1 * t1 / (count + 1 / (anchor_sigma * anchor_sigma));
      EXPECT_NEAR(bound[k](6, 6) * information, 1, 1e-9);
      EXPECT_NEAR(bound[k](0, 0) / (P0 + t * t / information), 1, 1e-9) << "relative views do not improve the start";
      EXPECT_EQ(bound[k](1, 1), 0);
    }
  }
}

// Dead reckoning: without points the bound is the motion model's, P = F P F' + Q, in closed form for constant
// orientation.
TEST(LinearisedBound, WithoutPointsIsDeadReckoning) {
  PointWorldProblem problem;
  problem.start_covariance(6, 6) = 0.04;
  for (std::size_t k = 0; k < 31; ++k)
    problem.truth.push_back(
        {static_cast<std::int64_t>(k) * 100'000'000, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});
  const Matrix12d P = SimulateLinearised(problem, 0).bound.back();
  EXPECT_NEAR(P(0, 0), 6.25 * 27 / 3 + 0.04 * 9, 1e-9);  // 3 s
  EXPECT_NEAR(P(0, 6), 6.25 * 9 / 2 + 0.04 * 3, 1e-9);
  EXPECT_NEAR(P(6, 6), 6.25 * 3 + 0.04, 1e-9);
  EXPECT_NEAR(P(3, 3), 27.0 / 3, 1e-9);
}

TEST(LinearisedBound, RefusesWhatCannotBe) {
  TestRandom random(84);
  PointWorldProblem problem = MakePointWorld(random, 5, 3);
  problem.sigma = 0;
  EXPECT_THROW(SimulateLinearised(problem, 0), InputError);
}

// Consistency of the linearised world's exact filter in every block: mean NEES of 400 runs at three frames in a band
// left with probability 1e-6 (false-alarm rate 3e-5). Control: the bound halved is rejected.
TEST(SimulateLinearised, HasTheBoundAsItsCovariance) {
  TestRandom random(85);
  const LinearisedRuns runs = SimulateLinearised(MakePointWorld(random, 60, 15), 400, 3);
  for (const StateBlock& block : kStateBlocks) {
    const auto nees = NeesOf(runs, block.start, block.size);
    const Band band = Chi2MeanBand(block.size, 400, 1 - 1e-6);
    for (const std::size_t k : {0u, 20u, 59u}) {
      double mean = 0;
      for (const auto& run : nees) mean += run[k] / 400;
      EXPECT_GT(mean, band.low) << block.name << " at " << k;
      EXPECT_LT(mean, band.high) << block.name << " at " << k;
      EXPECT_GT(2 * mean, band.high);
    }
    EXPECT_NEAR(nees[7][20] / Nees(runs.error[7][20].segment(block.start, block.size),
                                   runs.bound[20].block(block.start, block.start, block.size, block.size)),
                1, 1e-6);
  }
  // RMSE / bound over all frames and runs. Frames are dependent, hence wide limits: 400 runs leave about 2 %.
  const std::vector<std::vector<Matrix12d>> bounds(400, runs.bound);
  const BoundRatio ratio = CompareWithBound(runs.error, bounds);
  for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(ratio.overall[b], 1, 0.1);
  auto worse = runs.error;
  for (auto& run : worse)
    for (Vector12d& e : run) e *= 1.5;
  const BoundRatio half_again = CompareWithBound(worse, bounds);
  for (std::size_t b = 0; b < 4; ++b) {
    EXPECT_NEAR(half_again.overall[b], 1.5 * ratio.overall[b], 1e-12);
  }
}

// Whitened errors of 1200 runs, in units of the bound, with points that join and leave: uncorrelated, of variance one
// at each of nine frames. 702 entries within six standard deviations: false-alarm rate below 1e-5 (a variance's upper
// tail is heavier than a Gaussian's: 1e-8 at six). Controls: the errors of the previous frame; one component a fifth
// larger.
TEST(SimulateLinearised, HasIndependentErrorsInUnitsOfTheBound) {
  constexpr int kRuns = 1200;
  const LinearisedRuns runs = SimulateLinearised(InterruptedWorld(), kRuns, 5);
  const auto worst = [&](std::size_t of_errors, std::size_t of_bound, double times) {
    MatrixXd errors(12, kRuns);
    for (int m = 0; m < kRuns; ++m) errors.col(m) = runs.error[static_cast<std::size_t>(m)][of_errors];
    errors.row(7) *= times;
    const MatrixXd units = runs.bound[of_bound].llt().matrixL().solve(errors);
    MatrixXd off = (units * units.transpose() / kRuns - MatrixXd::Identity(12, 12)) * std::sqrt(kRuns);
    off.diagonal() /= std::sqrt(2.0);
    return off.cwiseAbs().maxCoeff();
  };
  ASSERT_EQ(runs.bound.size(), 9u);
  const auto nees = NeesOf(runs, 3, 3);
  ASSERT_EQ(nees[7].size(), 9u);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(nees[7][k] / Nees(runs.error[7][k].segment(3, 3), runs.bound[k].block(3, 3, 3, 3)), 1, 1e-9);
    EXPECT_LT(worst(k, k, 1), 6) << "frame " << k;
    EXPECT_GT(worst(k, k, 1.2), 6) << "frame " << k;
    if (k > 0) {
      EXPECT_GT(worst(k - 1, k, 1), 6) << "frame " << k;
    }
  }
}

// A hundred features for ten seconds: the bound is positive definite. The run time is recorded, not checked.
TEST(LinearisedBound, OfAHundredFeaturesAndTenSeconds) {
  TestRandom random(86);
  const PointWorldProblem problem = MakePointWorld(random, 300, 100, 0.3);
  const auto start = std::chrono::steady_clock::now();
  const auto bound = SimulateLinearised(problem, 0).bound;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  for (const Matrix12d& P : bound) {
    ASSERT_TRUE(P.allFinite());
    EXPECT_EQ(P.llt().info(), Eigen::Success);
  }
}

}  // namespace
}  // namespace evaluation
