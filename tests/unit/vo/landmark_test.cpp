#include "vo/map/landmark.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_update.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"
#include "vo/map/landmark_record.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using vo_test::Draws;

vo::Pose DrawPose(Draws& draws, double size) { return vo::Plus({}, size * draws.Symmetrics<6>()); }

TEST(Landmark, ProjectsLikeThePointItStandsFor) {
  Draws draws(1);
  for (int i = 0; i < 200; ++i) {
    const vo::Pose anchor = DrawPose(draws, 0.3), camera = DrawPose(draws, 0.3);
    const Vector3d theta = Vector3d(0, 0, 0.3) + Vector3d(0.4, 0.4, 0.25).cwiseProduct(draws.Symmetrics<3>());
    const Vector3d X_W = anchor.p_WC + anchor.q_WC.toRotationMatrix() * Vector3d(theta.x(), theta.y(), 1) / theta.z();
    const Vector3d X_C = camera.q_WC.toRotationMatrix().transpose() * (X_W - camera.p_WC);
    if (X_C.z() < 0.2) continue;
    const vo::Projection p = vo::Project({camera, anchor}, theta);
    ASSERT_TRUE(p.in_front);
    EXPECT_LT((p.z - X_C.head<2>() / X_C.z()).norm(), 1e-13);
    EXPECT_LT((vo::PointInWorld(anchor, theta) - X_W).norm(), 1e-12);
  }
}

TEST(Landmark, JacobiansAreTheDerivatives) {
  Draws draws(2);
  const double h = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const vo::Pose anchor = DrawPose(draws, 0.3), camera = DrawPose(draws, 0.3);
    const Vector3d theta = 0.4 * draws.Symmetrics<3>();  // rho <= 0 too
    const vo::Projection p = vo::Project({camera, anchor}, theta);
    if (!p.in_front || p.z.norm() > 2) continue;
    for (int k = 0; k < 6; ++k) {
      const vo::Vector6 d = h * vo::Vector6::Unit(k);
      const Vector2d numeric =
          (vo::Project({vo::Plus(camera, d), anchor}, theta).z - vo::Project({vo::Plus(camera, -d), anchor}, theta).z) /
          (2 * h);
      EXPECT_LT((p.J_pose.col(k) - numeric).norm(), 1e-8) << "pose " << k;
    }
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = h * Vector3d::Unit(k);
      const Vector2d numeric =
          (vo::Project({camera, anchor}, theta + d).z - vo::Project({camera, anchor}, theta - d).z) / (2 * h);
      EXPECT_LT((p.J_landmark.col(k) - numeric).norm(), 1e-8) << "landmark " << k;
    }
  }
}

TEST(Landmark, StaysFiniteAtInfinityAndIsRefusedBehind) {
  const vo::Pose anchor, camera{Vector3d(0.5, 0, 0), Eigen::Quaterniond::Identity()};
  const vo::Projection far = vo::Project({camera, anchor}, {0.1, 0.2, 0});
  ASSERT_TRUE(far.in_front);
  EXPECT_LT((far.z - Vector2d(0.1, 0.2)).norm(), 1e-15);
  const vo::Pose turned{Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitY()))};
  EXPECT_FALSE(vo::Project({turned, anchor}, {0, 0, 0.3}).in_front);
}

// log p(z | pose), the integral over rho, by brute force: Simpson's rule over +- 12 sigma.
double Quadrature(const vo::Landmark& prior, const vo::AnchorView& view, const vo::Match& match) {
  const double mean = prior.mean.z(), sigma = std::sqrt(prior.covariance(2, 2));
  const int n = 40000;
  double sum = 0;
  const Matrix2d R_inverse = match.R.inverse();
  for (int i = 0; i <= n; ++i) {
    const double x = -12 + 24.0 * i / n;
    const vo::Projection h = vo::Project(view, {prior.mean.x(), prior.mean.y(), mean + sigma * x});
    if (!h.in_front) continue;
    const Vector2d r = match.z - h.z;
    const double f = std::exp(-0.5 * r.dot(R_inverse * r) - 0.5 * x * x);
    sum += f * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2);
  }
  return std::log(sum * 24.0 / n / 3) - 0.5 * std::log(2 * std::numbers::pi) - std::log(2 * std::numbers::pi) -
         0.5 * std::log(match.R.determinant());
}

// Laplace's approximation of the weight against the integral, for a depth two to four standard deviations from its
// prior mean. Control: the linearisation at the prior (3), whose error is far larger (section 8).
TEST(Landmark, LaplaceWeightIsTheIntegral) {
  Draws draws(3);
  double worst_iterated = 0, worst_prior = 0;
  for (int i = 0; i < 100; ++i) {
    const vo::Pose anchor,
        camera{Vector3d{0.1 * draws.Symmetric(), 0.1 * draws.Symmetric(), 0.25}, vo::Exp(0.02 * draws.Symmetrics<3>())};
    vo::Landmark prior;
    prior.mean << 0.3 * draws.Symmetrics<2>(), 0.25;
    prior.covariance(2, 2) = 0.15 * 0.15;
    const vo::AnchorView view(camera, anchor);
    vo::Match match;
    match.R = Matrix2d::Identity() / (500.0 * 500.0);
    const double inverse_depth = 0.55 + 0.2 * draws.Uniform();
    match.z = vo::Project(view, {prior.mean.x(), prior.mean.y(), inverse_depth}).z + draws.Symmetrics<2>() / 500;
    const double truth = Quadrature(prior, view, match);
    worst_iterated = std::max(
        worst_iterated, std::abs(vo_test::UpdateLandmark(prior, prior.mean, view, match, 10).log_likelihood - truth));
    worst_prior = std::max(worst_prior,
                           std::abs(vo_test::UpdateLandmark(prior, prior.mean, view, match, 1).log_likelihood - truth));
  }
  EXPECT_LT(worst_iterated, 0.05);
  EXPECT_GT(worst_prior, 1.0);
}

// Linear case: with a sideways translation the measurement is linear in rho, (3) is the integral, and the update is
// Bayes' rule.
TEST(Landmark, LinearCaseIsExact) {
  const vo::Pose anchor, camera{Vector3d(0.3, -0.2, 0), Eigen::Quaterniond::Identity()};
  vo::Landmark prior;
  prior.mean = {0.1, -0.2, 0.25};
  prior.covariance(2, 2) = 0.15 * 0.15;
  const vo::AnchorView view(camera, anchor);
  vo::Match match;
  match.R << 4e-6, 1e-6, 1e-6, 3e-6;
  match.z = vo::Project(view, {0.1, -0.2, 0.45}).z + Vector2d(0.001, -0.002);
  for (const int iterations : {1, 10}) {
    const vo_test::LandmarkUpdate update = vo_test::UpdateLandmark(prior, prior.mean, view, match, iterations);
    EXPECT_NEAR(update.log_likelihood, Quadrature(prior, view, match), 1e-8);
    const Vector2d J = vo::Project(view, prior.mean).J_landmark.col(2);
    const double information = 1 / prior.covariance(2, 2) + J.dot(match.R.inverse() * J);
    EXPECT_NEAR(update.landmark.covariance(2, 2), 1 / information, 1e-12);
    EXPECT_EQ(update.landmark.mean.x(), 0.1);  // bearing fixed: only rho moves
  }
}

TEST(Existence, FollowsThePrintedFormulas) {
  const vo::ScoreParams p;
  EXPECT_NEAR(vo::PredictScore(0.8, p), 0.95 * 0.8 + 0.05 * 0.2, 1e-15);  // (44)
  EXPECT_NEAR(vo::PredictScore(0.5, p), 0.5, 1e-15);                      // its fixed point
  const double PDPG = 0.75 * 0.995;
  EXPECT_NEAR(vo::UpdateScore(0.5, std::nullopt, p), (1 - PDPG) / (1 - PDPG * 0.5) * 0.5, 1e-15);
  EXPECT_NEAR(vo::UpdateScore(0.5, std::nullopt, p), 0.20239, 1e-5);  // one miss deletes a new feature
  // (45)-(48) with |S| written out, for two very different S: the score does not depend on it.
  for (const double s : {0.01, 1.0, 400.0}) {
    const Matrix2d S = s * (Matrix2d() << 2.0, 0.3, 0.3, 1.0).finished();
    const Vector2d nu = std::sqrt(s) * Vector2d(0.9, -0.7);
    const double d2 = nu.dot(S.inverse() * nu), P = 0.6;
    const double V_G = std::numbers::pi * std::sqrt(S.determinant()) * 9.21;
    const double Lambda = std::exp(-0.5 * d2) / (2 * std::numbers::pi * std::sqrt(S.determinant())) / 0.995;
    const double delta = PDPG * (1 - V_G / (1 - PDPG * P) * Lambda);
    EXPECT_NEAR(vo::UpdateScore(P, d2, p), (1 - delta) / (1 - delta * P) * P, 1e-12) << s;
  }
  EXPECT_GT(vo::UpdateScore(0.5, 1.0, p), 0.5);
  EXPECT_LT(vo::UpdateScore(0.5, 40.0, p), 0.5);
}

}  // namespace
