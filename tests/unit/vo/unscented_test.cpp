#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/unit/vo/landmark_update.h"
#include "tests/unit/vo/propose.h"
#include "vo/filter/unscented_proposal.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

template <int N>
Eigen::Matrix<double, N, N> SomeCovariance() {
  Eigen::Matrix<double, N, N> root;
  for (int i = 0; i < N * N; ++i) root(i / N, i % N) = std::sin(1.7 * (i + 1));
  return root * root.transpose() + 0.1 * Eigen::Matrix<double, N, N>::Identity();
}

const std::vector<vo::UnscentedParams> kSpreads = {{1, 2, 0}, {1, 2, 3}, {0.5, 2, 0}, {1e-2, 2, 0}, {1, 1, 0}};

TEST(Unscented, IsExactForALinearFunction) {
  const Eigen::Matrix<double, 5, 5> P = SomeCovariance<5>();
  Eigen::Matrix<double, 3, 5> A;
  for (int i = 0; i < 15; ++i) A(i / 5, i % 5) = std::cos(2.3 * i);
  const Vector3d b(1, -2, 3);
  for (const vo::UnscentedParams& params : kSpreads) {
    const auto y = vo::UnscentedTransform<3, 5>(
        P, params, [&](const Eigen::Matrix<double, 5, 1>& x) -> Vector3d { return A * x + b; });
    EXPECT_LT((y.mean - b).norm(), 1e-11) << params.alpha;
    EXPECT_LT((y.covariance - A * P * A.transpose()).norm(), 1e-9 * P.norm()) << params.alpha;
    EXPECT_LT((y.cross - P * A.transpose()).norm(), 1e-9 * P.norm()) << params.alpha;
  }
}

// y = x^2, x ~ N(m, s^2): the mean m^2 + s^2 is exact for any spread. The variance of the transform is 4 m^2 s^2 +
// (alpha^2 kappa' - 1 + beta - alpha^2 + 1) s^4 with kappa' = n + kappa and n = 1, and the true 4 m^2 s^2 + 2 s^4 for
// the defaults.
TEST(Unscented, QuadraticHasTheKnownResult) {
  const double m = 1.3, s = 0.7;
  for (const vo::UnscentedParams& params : kSpreads) {
    const auto y = vo::UnscentedTransform<1, 1>(
        Eigen::Matrix<double, 1, 1>(s * s), params,
        [&](const Eigen::Matrix<double, 1, 1>& x) { return Eigen::Matrix<double, 1, 1>((m + x[0]) * (m + x[0])); });
    EXPECT_NEAR(y.mean[0], m * m + s * s, 1e-11);
    EXPECT_NEAR(y.cross(0, 0), 2 * m * s * s, 1e-11);
    const double a2 = params.alpha * params.alpha;
    EXPECT_NEAR(y.covariance(0, 0), 4 * m * m * s * s + (a2 * (1 + params.kappa) + params.beta - a2) * s * s * s * s,
                1e-9);
  }
  const auto y = vo::UnscentedTransform<1, 1>(
      Eigen::Matrix<double, 1, 1>(s * s), {},
      [&](const Eigen::Matrix<double, 1, 1>& x) { return Eigen::Matrix<double, 1, 1>((m + x[0]) * (m + x[0])); });
  EXPECT_NEAR(y.covariance(0, 0), 4 * m * m * s * s + 2 * s * s * s * s, 1e-12)
      << "defaults, n = 1: exact for a Gaussian";
}

// In several dimensions, h = x' B x: mean trace(B P) exactly.
TEST(Unscented, MeanOfAQuadraticFormIsExact) {
  const Eigen::Matrix<double, 6, 6> P = SomeCovariance<6>(), B = SomeCovariance<6>();
  for (const vo::UnscentedParams& params : kSpreads) {
    const auto y = vo::UnscentedTransform<1, 6>(
        P, params, [&](const vo::Vector6& x) { return Eigen::Matrix<double, 1, 1>(x.dot(B * x)); });
    EXPECT_NEAR(y.mean[0], (B * P).trace(), 1e-9 * (B * P).trace());
  }
}

TEST(Unscented, RootOfASemidefiniteMatrix) {
  Eigen::Matrix<double, 4, 2> thin;
  for (int i = 0; i < 8; ++i) thin(i / 2, i % 2) = std::sin(3.1 * (i + 1));
  const Eigen::Matrix4d P = thin * thin.transpose();  // rank 2
  const Eigen::Matrix4d C = vo::SemidefiniteRoot<4>(P);
  EXPECT_LT((C * C.transpose() - P).norm(), 1e-7);
  EXPECT_TRUE(vo::SemidefiniteRoot<4>(Eigen::Matrix4d::Zero()).isZero(0));
}

// Landmarks anchored at two poses, seen from a third.
struct Scene {
  std::vector<vo::Landmark> landmarks;
  std::vector<int> anchor_of;
  std::vector<vo::Pose> anchors;
  std::vector<vo::Match> matches;
  vo::PoseGaussian prediction;
  vo::LocalMap map() const { return {landmarks, anchor_of, anchors}; }
};

Scene MakeScene(std::uint64_t seed, int count, double pose_scale, double depth_sigma, double noise, bool fixed) {
  const auto normal = [&, d = 0u]() mutable { return vo::Normal({.seed = seed}, d++); };
  auto draw = normal;
  Scene scene;
  scene.anchors = {vo::Pose{}, vo::Pose{Vector3d(0.05, 0.02, -0.03), vo::Exp({0.01, -0.02, 0.01})}};
  scene.prediction.mean = {Vector3d(0.15, -0.05, 0.1), vo::Exp({0.02, 0.03, -0.02})};
  scene.prediction.covariance = pose_scale * pose_scale * SomeCovariance<6>();
  vo::Vector6 n;
  for (double& x : n) x = draw();
  const vo::Pose truth = vo::Plus(scene.prediction.mean, scene.prediction.covariance.llt().matrixL() * n);
  for (int i = 0; i < count; ++i) {
    vo::Landmark landmark;
    const Vector3d theta(0.5 * std::sin(1.3 * i), 0.4 * std::cos(2.1 * i), 0.35 + 0.15 * std::sin(0.7 * i));
    landmark.mean = theta;
    if (!fixed) landmark.mean.head<2>() += noise * Vector2d{draw(), draw()};
    landmark.mean.z() += depth_sigma * draw();
    landmark.covariance(2, 2) = depth_sigma * depth_sigma;
    if (!fixed) landmark.covariance.topLeftCorner<2, 2>() = noise * noise * Matrix2d::Identity();
    scene.landmarks.push_back(landmark);
    scene.anchor_of.push_back(i % 2);
    const vo::Projection h = vo::Project({truth, scene.anchors[static_cast<std::size_t>(i % 2)]}, theta);
    scene.matches.push_back({i, h.z + noise * Vector2d{draw(), draw()}, noise * noise * Matrix2d::Identity()});
  }
  return scene;
}

// Unscented proposal of a nearly linear model: that of the EKF, up to a difference that falls with the square of the
// spread.
TEST(UnscentedProposal, IsTheEkfWhereTheModelIsLinear) {
  for (const bool fixed : {false, true}) {
    const Scene scene = MakeScene(3, 12, 1e-6, 1e-6, 1e-6, fixed);
    const vo::PoseProposal ukf = vo::ProposeUnscented(scene.prediction, scene.map(), scene.matches, {});
    const vo::PoseProposal ekf =
        vo_test::Propose(scene.prediction, scene.map(), scene.matches, {.proposal = vo::Proposal::ekf});
    const vo::Matrix6 L = ekf.pose.covariance.llt().matrixL();
    EXPECT_LT((L.inverse() * vo::Minus(ukf.pose.mean, ekf.pose.mean)).norm(), 1e-3);
    EXPECT_LT((ukf.pose.covariance - ekf.pose.covariance).norm(), 1e-4 * ekf.pose.covariance.norm());
    EXPECT_NEAR(ukf.log_evidence, ekf.log_evidence, 1e-4 * std::abs(ekf.log_evidence));
    for (const vo::Match& match : scene.matches) {
      const vo::AnchorView view(scene.prediction.mean,
                                scene.anchors[static_cast<std::size_t>(scene.anchor_of[match.landmark])]);
      const vo::Landmark& prior = scene.landmarks[static_cast<std::size_t>(match.landmark)];
      const auto a = vo::UpdateLandmarkUnscented(prior, view, match, {}),
                 b = vo_test::UpdateLandmark(prior, prior.mean, view, match, 1);
      EXPECT_LT((a.landmark.mean - b.landmark.mean).norm(), 1e-9);
      EXPECT_LT((a.landmark.covariance - b.landmark.covariance).norm(), 1e-4 * b.landmark.covariance.norm());
      EXPECT_NEAR(a.log_likelihood, b.log_likelihood, 1e-4 * std::abs(b.log_likelihood));
    }
  }
}

// Statistical linearisation in information form with one feature: the update with gain P_xz P_zz^-1.
TEST(UnscentedProposal, OneFeatureIsTheTextbookUpdate) {
  const Scene scene = MakeScene(5, 1, 0.05, 0.1, 0.01, false);
  const vo::Landmark& landmark = scene.landmarks[0];
  const vo::Matrix6& P = scene.prediction.covariance;
  const auto z = vo::UnscentedTransform<2, 6>(P, {}, [&](const vo::Vector6& offset) {
    return vo::Project({vo::Plus(scene.prediction.mean, offset), scene.anchors[0]}, landmark.mean).z;
  });
  const vo::Matrix23 J = vo::Project({scene.prediction.mean, scene.anchors[0]}, landmark.mean).J_landmark;
  const Matrix2d S = z.covariance + J * landmark.covariance * J.transpose() + scene.matches[0].R;
  const Eigen::Matrix<double, 6, 2> K = z.cross * S.inverse();
  const Vector2d e = scene.matches[0].z - z.mean;
  const vo::Vector6 d = K * e;
  vo::Matrix6 turn = vo::Matrix6::Identity();
  turn.bottomRightCorner<3, 3>() = vo::RightJacobian(d.tail<3>());
  const vo::PoseProposal ukf = vo::ProposeUnscented(scene.prediction, scene.map(), scene.matches, {});
  EXPECT_LT(vo::Minus(ukf.pose.mean, vo::Plus(scene.prediction.mean, d)).norm(), 1e-10);
  EXPECT_LT((ukf.pose.covariance - turn * (P - K * S * K.transpose()) * turn.transpose()).norm(), 1e-9 * P.norm());
  EXPECT_NEAR(ukf.log_evidence, -0.5 * e.dot(S.inverse() * e) - 0.5 * std::log(S.determinant()) - std::log(2 * M_PI),
              1e-8);
}

// Mean of the transform far from linear: closer to the true mean (10^5 samples) than the projection of the mean.
TEST(UnscentedProposal, MeanBeatsTheLinearisation) {
  vo::Landmark landmark;
  landmark.mean = Vector3d(0.2, -0.1, 0.25);
  landmark.covariance(2, 2) = 0.15 * 0.15;
  const vo::AnchorView view({Vector3d(0.3, 0.1, 1.0), vo::Exp({0.0, 0.1, 0.0})}, {});
  const auto h = [&](double rho) { return vo::Project(view, {0.2, -0.1, rho}).z; };
  Vector2d sampled = Vector2d::Zero();
  constexpr int kDraws = 100000;
  for (std::uint32_t i = 0; i < kDraws; ++i)
    sampled += h(0.25 + 0.15 * vo::Normal({.seed = 8, .particle = i}, 0)) / kDraws;
  const auto z = vo::UnscentedTransform<2, 1>(Eigen::Matrix<double, 1, 1>(0.15 * 0.15), {},
                                              [&](const Eigen::Matrix<double, 1, 1>& d) { return h(0.25 + d[0]); });
  EXPECT_LT((z.mean - sampled).norm(), 0.35 * (h(0.25) - sampled).norm());
}

}  // namespace
