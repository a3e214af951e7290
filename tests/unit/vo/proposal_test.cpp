#include "vo/filter/proposal.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <numbers>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_update.h"
#include "tests/unit/vo/propose.h"
#include "vo/filter/consensus.h"
#include "vo/filter/gauss_newton.h"
#include "vo/filter/particle_set.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using vo_test::Draws;

// Landmarks anchored at two poses, seen from a third with pixel noise.
struct Scene {
  std::vector<vo::Landmark> landmarks;
  std::vector<int> anchor_of;
  std::vector<vo::Pose> anchors;
  std::vector<vo::Match> matches;
  vo::PoseGaussian prediction;
  vo::LocalMap map() const { return {landmarks, anchor_of, anchors}; }
};

Scene MakeScene(unsigned seed, int count, double depth_sigma, double noise = 1.0 / 500) {
  Draws draws(seed);
  Scene scene;
  scene.anchors = {vo::Pose{}, vo::Pose{Vector3d(0.05, 0.02, -0.03), vo::Exp({0.01, -0.02, 0.01})}};
  scene.prediction.mean = {Vector3d(0.15, -0.05, 0.1), vo::Exp({0.02, 0.03, -0.02})};
  scene.prediction.covariance.diagonal() << 1e-4, 1e-4, 1e-4, 2e-5, 2e-5, 2e-5;
  const vo::Vector6 off = scene.prediction.covariance.diagonal().cwiseSqrt().cwiseProduct(draws.Normals<6>());
  const vo::Pose truth = vo::Plus(scene.prediction.mean, off);
  for (int n = 0; n < count; ++n) {
    vo::Landmark landmark;
    const Vector3d theta{draws.Uniform() - 0.5, 0.7 * (draws.Uniform() - 0.5), 0.2 + 0.5 * draws.Uniform()};
    landmark.mean = theta + Vector3d(noise, noise, depth_sigma).cwiseProduct(draws.Normals<3>());
    landmark.covariance.diagonal() << noise * noise, noise * noise, depth_sigma * depth_sigma;
    scene.landmarks.push_back(landmark);
    scene.anchor_of.push_back(n % 2);
    const vo::Projection h = vo::Project({truth, scene.anchors[n % 2]}, theta);
    scene.matches.push_back({n, h.z + noise * draws.Normals<2>(), noise * noise * Eigen::Matrix2d::Identity()});
  }
  return scene;
}

// Cost of the iterated proposal as one stacked residual over (pose, all landmarks): the reference.
VectorXd StackedResidual(const Scene& scene, const vo::Pose& pose, const VectorXd& landmarks) {
  const int n = static_cast<int>(scene.landmarks.size());
  VectorXd r(6 + 5 * n);
  r.head<6>() = scene.prediction.covariance.llt().matrixL().solve(vo::Minus(pose, scene.prediction.mean));
  for (int i = 0; i < n; ++i) {
    const Vector3d theta = landmarks.segment<3>(3 * i);
    r.segment<3>(6 + 5 * i) =
        (theta - scene.landmarks[i].mean).cwiseQuotient(scene.landmarks[i].covariance.diagonal().cwiseSqrt());
    const vo::Projection h = vo::Project({pose, scene.anchors[scene.anchor_of[i]]}, theta);
    r.segment<2>(9 + 5 * i) = (h.z - scene.matches[i].z) / std::sqrt(scene.matches[i].R(0, 0));
  }
  return r;
}

// Joint solution by Gauss-Newton on the pose and all landmarks, with numeric Jacobians.
struct Joint {
  vo::Pose pose;
  vo::Matrix6 covariance;
};
Joint SolveJointly(const Scene& scene) {
  const int n = static_cast<int>(scene.landmarks.size());
  vo::Pose pose = scene.prediction.mean;
  VectorXd landmarks(3 * n);
  for (int i = 0; i < n; ++i) landmarks.segment<3>(3 * i) = scene.landmarks[i].mean;
  MatrixXd J(6 + 5 * n, 6 + 3 * n);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const double h = 1e-6;
    for (int k = 0; k < 6 + 3 * n; ++k) {
      VectorXd d = VectorXd::Zero(6 + 3 * n);
      d[k] = h;
      J.col(k) = (StackedResidual(scene, vo::Plus(pose, d.head<6>()), landmarks + d.tail(3 * n)) -
                  StackedResidual(scene, vo::Plus(pose, -d.head<6>()), landmarks - d.tail(3 * n))) /
                 (2 * h);
    }
    const VectorXd step = -J.householderQr().solve(StackedResidual(scene, pose, landmarks));
    pose = vo::Plus(pose, step.head<6>());
    landmarks += step.tail(3 * n);
    if (step.norm() < 1e-11) break;
  }
  const MatrixXd covariance = (J.transpose() * J).inverse();
  return {pose, covariance.topLeftCorner<6, 6>()};
}

// Schur complement against the joint solution, to the tolerance of Settled. Control: one step alone is more than ten
// times farther away.
TEST(Proposal, SchurEliminationIsTheJointSolution) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Scene scene = MakeScene(seed, 12, 0.15);
    const Joint joint = SolveJointly(scene);
    const vo::PoseProposal proposal =
        vo_test::Propose(scene.prediction, scene.map(), scene.matches, {.max_iterations = 50});
    const auto distance = [&](const vo::PoseProposal& from) {  // [standard deviations]
      const vo::Vector6 d = vo::Minus(from.pose.mean, joint.pose);
      return std::sqrt(d.dot(joint.covariance.llt().solve(d)));
    };
    EXPECT_LT(distance(proposal), vo::kToleranceSigma) << "seed " << seed;
    EXPECT_GT(distance(vo_test::Propose(scene.prediction, scene.map(), scene.matches, {.max_iterations = 1})),
              10 * vo::kToleranceSigma)
        << "seed " << seed;
    EXPECT_LT((proposal.pose.covariance - joint.covariance).norm() / joint.covariance.norm(), 1e-3) << "seed " << seed;
  }
}

TEST(Proposal, EkfIsOneStepOfIt) {
  const Scene scene = MakeScene(3, 12, 0.15);
  const vo::PoseProposal ekf =
      vo_test::Propose(scene.prediction, scene.map(), scene.matches, {.proposal = vo::Proposal::ekf});
  const vo::PoseProposal one = vo_test::Propose(scene.prediction, scene.map(), scene.matches, {.max_iterations = 1});
  EXPECT_EQ(vo::Minus(ekf.pose.mean, one.pose.mean).norm(), 0);
  EXPECT_GT(vo::Minus(ekf.pose.mean, SolveJointly(scene).pose).norm(), 1e-4)
      << "where depths are unknown it is not the mode";
}

TEST(Proposal, NoMatchesIsThePrediction) {
  const Scene scene = MakeScene(1, 5, 0.1);
  const vo::PoseProposal proposal = vo_test::Propose(scene.prediction, scene.map(), {}, {});
  EXPECT_EQ(vo::Minus(proposal.pose.mean, scene.prediction.mean).norm(), 0);
  EXPECT_EQ(proposal.pose.covariance, scene.prediction.covariance);
}

// Importance weight (17) of a linear Gaussian model: equal at all samples, and equal to the evidence. The noise is so
// small that curvature vanishes; rounding remains.
TEST(Proposal, EvidenceEqualsTheImportanceWeightWhenLinear) {
  const double tiny = 1e-7;
  Scene scene = MakeScene(4, 10, 1e-6, tiny);
  scene.prediction.covariance *= 1e-10;
  Draws draws(9);
  for (vo::Match& match : scene.matches) {  // measurements consistent with the small prior
    const vo::Projection h = vo::Project({scene.prediction.mean, scene.anchors[scene.anchor_of[match.landmark]]},
                                         scene.landmarks[match.landmark].mean);
    match.z = h.z + tiny * draws.Normals<2>();
  }
  const vo::PoseProposal proposal = vo_test::Propose(scene.prediction, scene.map(), scene.matches, {});
  for (std::uint32_t i = 0; i < 20; ++i) {
    const vo::Pose s = proposal.pose.Sample({.seed = 5, .particle = i});
    double log_weight = scene.prediction.LogDensity(s) - proposal.pose.LogDensity(s);
    for (const vo::Match& match : scene.matches)
      log_weight += vo_test::UpdateLandmark(scene.landmarks[match.landmark], scene.landmarks[match.landmark].mean,
                                            {s, scene.anchors[scene.anchor_of[match.landmark]]}, match, 10)
                        .log_likelihood;
    EXPECT_NEAR(log_weight, proposal.log_evidence, 1e-4 * std::abs(proposal.log_evidence) * 1e-2) << i;
  }
}

TEST(Consensus, ThrowsOutGrossErrorsAndKeepsTheRest) {
  // A residual has about 1.6 px per axis, so the gate's radius is 4.8 px. An outlier of 12 px passes only with a
  // deviation of 4.5 sigma (240 outliers: 1e-3).
  int refused_inliers = 0, kept_outliers = 0, inliers = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene = MakeScene(seed, 60, 0.01);
    Draws draws(seed + 100);
    std::vector<bool> corrupted(60, false);
    for (int n = 0; n < 60; n += 5) {
      corrupted[n] = true;
      const double angle = 2 * std::numbers::pi * draws.Uniform(), length = (12 + 28 * draws.Uniform()) / 500;
      scene.matches[n].z += length * Vector2d(std::cos(angle), std::sin(angle));
    }
    const std::vector<bool> inlier = vo::FindInliers(scene.prediction, scene.map(), scene.matches, 9.21, {});
    for (int n = 0; n < 60; ++n) {
      if (corrupted[n]) kept_outliers += inlier[n];
      if (!corrupted[n]) refused_inliers += !inlier[n];
      inliers += !corrupted[n];
    }
  }
  // Binomial(960, 0.01): more than 24 has probability 1e-4.
  EXPECT_LE(refused_inliers, 24) << "of " << inliers;
  EXPECT_EQ(kept_outliers, 0);
}

TEST(Consensus, IsTheSameFromNearby) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene = MakeScene(seed, 60, 0.01);
    for (std::size_t n = 0; n < 60; n += 5) scene.matches[n].z.x() += 0.05;
    const vo::Consensus cold = vo::FindConsensus(scene.prediction, scene.map(), scene.matches, 9.21, {});
    const vo::Vector6 away = 5 * cold.pose.covariance.diagonal().cwiseSqrt();
    const vo::Consensus warm =
        vo::FindConsensus(scene.prediction, scene.map(), scene.matches, 9.21, {}, vo::Plus(cold.pose.mean, away));
    EXPECT_EQ(warm.inlier, cold.inlier) << "seed " << seed;
    const vo::Vector6 d = vo::Minus(warm.pose.mean, cold.pose.mean);
    EXPECT_LT(std::sqrt(d.dot(cold.pose.covariance.llt().solve(d))), 0.1)
        << "seed " << seed;  // tolerance of a round's convergence
  }
}

TEST(PoseGaussian, DensityIntegratesAndSamplesHaveItsCovariance) {
  vo::PoseGaussian g;
  g.mean = {Vector3d(1, 2, 3), vo::Exp({0.3, -0.2, 0.5})};
  vo::Matrix6 root;
  for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = 0.03 * std::sin(1.7 * (k + 1));
  g.covariance = root * root.transpose() + 1e-4 * vo::Matrix6::Identity();
  const int n = 20000;
  vo::Matrix6 second = vo::Matrix6::Zero();
  for (std::uint32_t i = 0; i < n; ++i) {
    const vo::Vector6 d = vo::Minus(g.Sample({.seed = 3, .particle = i}), g.mean);
    second += d * d.transpose() / n;
  }
  // Each whitened second moment is 1 +- sqrt(2/n), off-diagonal 0 +- 1/sqrt(n): 5 sigma, 21 entries: false-alarm rate
  // 1e-5.
  const vo::Matrix6 L = g.covariance.llt().matrixL();
  const vo::Matrix6 white = L.inverse() * second * L.inverse().transpose();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) EXPECT_NEAR(white(i, j), i == j, 5 * std::sqrt((i == j ? 2.0 : 1.0) / n)) << i << j;
  EXPECT_NEAR(g.LogDensity(g.mean), -0.5 * std::log(g.covariance.determinant()) - 3 * std::log(2 * std::numbers::pi),
              1e-9);
}

// Samples of a semidefinite covariance: no spread in the known directions (one axis of the position, and a rotation
// about an oblique axis), the full covariance in all others.
TEST(PoseGaussian, SamplesOfASemidefiniteCovarianceHaveIt) {
  vo::PoseGaussian g;
  g.mean = {Vector3d(1, 2, 3), vo::Exp({0.3, -0.2, 0.5})};
  Eigen::Matrix<double, 6, 4> root = Eigen::Matrix<double, 6, 4>::Zero();
  for (const int row : {1, 2, 3, 4, 5})
    for (int k = 0; k < 4; ++k) root(row, k) = 0.03 * std::sin(1.7 * (4 * row + k + 1));
  g.covariance = root * root.transpose();
  vo::Matrix6 spread = vo::Matrix6::Zero();  // of the samples, which are linear in six normal numbers
  for (int i = 0; i < 6; ++i) {
    const vo::Vector6 d = vo::Minus(g.Displaced(vo::Vector6::Unit(i)), g.mean);
    spread += d * d.transpose();
  }
  EXPECT_LT((spread - g.covariance).norm(), 1e-9 * g.covariance.norm());
}

TEST(Resampling, CopiesAreWithinOneOfExpected) {
  const std::vector<double> w = {0.05, 0.45, 0.0, 0.3, 0.2};
  std::vector<int> ancestors;
  for (const double u : {0.0, 0.13, 0.5, 0.999}) {
    std::vector<int> copies(w.size(), 0);
    vo::SystematicAncestors(w, u, ancestors);
    for (const int a : ancestors) ++copies[a];
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_LT(std::abs(copies[i] - 5 * w[i]), 1.0);
  }
  // Unbiased: over all u the mean number of copies is N w exactly.
  std::vector<double> mean(w.size(), 0);
  const int n = 10000;
  for (int k = 0; k < n; ++k) {
    vo::SystematicAncestors(w, (k + 0.5) / n, ancestors);
    for (const int a : ancestors) mean[a] += 1.0 / n;
  }
  for (std::size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(mean[i], 5 * w[i], 1e-3);
}

}  // namespace
