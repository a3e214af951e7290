// Gaussian whose lengths are multiplied by a log-normal factor: closed form against draws.
#include "vo/scale_ambiguity.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "vo/point_odometry.h"

namespace {

using vo::Matrix12;
using Vector12 = Eigen::Matrix<double, 12, 1>;

TEST(ScaleAmbiguity, IsTheSecondMomentOfWhatItMayBe) {
  vo_test::Draws draws(1);
  Matrix12 A;
  for (double& a : A.reshaped()) a = 0.1 * draws.Normal();
  const Matrix12 P = A * A.transpose();
  const Eigen::Vector3d start(1, 2, 3);
  vo::Pose pose;
  pose.p_WC = start + Eigen::Vector3d(0.5, -0.2, 1);
  vo::Vector6 velocity;
  velocity << 0.3, 0.1, -0.2, 1, 2, 3;
  const double sigma = 0.3;
  const Matrix12 wide = vo::ScaleAmbiguity(sigma, start).Covariance(pose, velocity, P);

  const Matrix12 L = P.llt().matrixL();
  Vector12 at = Vector12::Zero();  // mean lengths, relative to the start; angles are about their means
  at.segment<3>(0) = pose.p_WC - start;
  at.segment<3>(6) = velocity.head<3>();
  Matrix12 sum = Matrix12::Zero();
  constexpr int kDraws = 400'000;
  for (int i = 0; i < kDraws; ++i) {
    Vector12 x = at + L * draws.Normals<12>();
    const double factor = std::exp(-sigma * draws.Normal());
    x.segment<3>(0) *= factor;
    x.segment<3>(6) *= factor;
    sum += (x - at) * (x - at).transpose() / kDraws;
  }
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j)
      EXPECT_NEAR(wide(i, j), sum(i, j), 0.02 * std::sqrt(sum(i, i) * sum(j, j))) << i << " " << j;  // 5 sigma and more
  }
  EXPECT_GT(Eigen::LLT<Matrix12>(wide).matrixL().determinant(), 0);
}

// Scale of the answers: unchanged where the filter's lengths double; the filter's own where the scale is known.
TEST(ScaleAmbiguity, AnswersKeepTheirScale) {
  vo_test::Draws draws(2);
  Matrix12 A;
  for (double& a : A.reshaped()) a = 0.1 * draws.Normal();
  const Matrix12 P = A * A.transpose();
  const Eigen::Vector3d start(1, 2, 3), way(0.5, -0.2, 1);
  vo::Pose pose, longer;
  pose.p_WC = start + way;
  longer.p_WC = start + 2 * way;
  vo::Vector6 velocity, faster;
  velocity << 0.3, 0.1, -0.2, 1, 2, 3;
  faster << 0.6, 0.2, -0.4, 1, 2, 3;
  Vector12 twice = Vector12::Ones();
  twice.segment<3>(0) *= 2;
  twice.segment<3>(6) *= 2;
  const Matrix12 P_longer = twice.asDiagonal() * P * twice.asDiagonal();

  const vo::ScaleAmbiguity before(0.3, start);
  vo::ScaleAmbiguity after = before;
  after.AbsorbChange(4);
  after.AbsorbChange(0.5);
  EXPECT_LT((after.ToAnswer(longer).p_WC - pose.p_WC).norm(), 1e-15);
  EXPECT_LT((after.ToAnswer(faster) - velocity).norm(), 1e-15);
  EXPECT_LT((after.Covariance(longer, faster, P_longer) - before.Covariance(pose, velocity, P)).norm(), 1e-14);
  const vo::PointMoments point{start + way, P.topLeftCorner<3, 3>()}, far{start + 2 * way, 4 * P.topLeftCorner<3, 3>()};
  EXPECT_LT((after.Moments(far).mean - point.mean).norm(), 1e-15);
  EXPECT_LT((after.Moments(far).covariance - before.Moments(point).covariance).norm(), 1e-14);
  EXPECT_EQ(after.InverseToAnswer(0.25), 0.5);
  EXPECT_NEAR(after.InverseDepthSigma(0.25, 0.1), before.InverseDepthSigma(0.5, 0.2), 1e-15);

  vo::ScaleAmbiguity known(0, start);
  known.AbsorbChange(2);
  EXPECT_EQ(known.ToAnswer(longer).p_WC, longer.p_WC);
  EXPECT_EQ(known.Covariance(longer, faster, P_longer), P_longer);
}

TEST(ScaleAmbiguity, KnownChangesNoBit) {
  const vo::ScaleAmbiguity known(0, {1, 2, 3});
  const Matrix12 P = Matrix12::Random();
  EXPECT_EQ(known.Covariance({}, vo::Vector6::Ones(), P), P);
  const vo::PointMoments point{{1, 2, 4}, Eigen::Matrix3d::Identity() * 0.1};
  EXPECT_EQ(known.Moments(point).covariance, point.covariance);
  EXPECT_EQ(known.InverseDepthSigma(0.3, 0.125), 0.125);
}

// Moments of the mixture over particles, of which ranks and coverage are computed: mean and covariance of the estimate.
TEST(ScaleAmbiguity, TheMixturesMomentsAreTheEstimate) {
  const vo::Camera camera;
  vo::Params params;
  params.filter = vo_test::SampledAtOnce();
  params.landmark.scale_sigma = 0.5;
  params.filter.start_window = 0;
  for (const int particles : {1, 8}) {
    params.filter.particles = particles;
    vo::Prior prior;
    prior.v_WC = {1, 0.3, 0};
    prior.velocity_covariance = 0.01 * vo::Matrix6::Identity();
    vo::PointOdometry odometry(camera, params, prior, 1);
    vo_test::Draws draws(3);
    std::vector<Eigen::Vector3d> points;
    for (int n = 0; n < 30; ++n)
      points.push_back(Eigen::Vector3d(2, 1.5, 1).cwiseProduct(draws.Symmetrics<3>()) + Eigen::Vector3d(0, 0, 4));
    for (int k = 0; k < 12; ++k) {
      vo::PointFrame frame{k * 33'000'000, {}};
      for (std::size_t n = 0; n < points.size(); ++n)
        frame.observations.push_back({static_cast<std::int64_t>(n),
                                      camera.Project(points[n] - 0.033 * k * prior.v_WC) + 0.7 * draws.Normals<2>()});
      const vo::Estimate estimate = odometry.Track(frame);
      if (k == 0) continue;
      const vo::Belief moments = vo::Moments(odometry.Mixture());
      EXPECT_LT((moments.pose.p_WC - estimate.pose.p_WC).norm(), 1e-12) << k;
      EXPECT_LT((moments.velocity.head<3>() - estimate.v_WC).norm(), 1e-12) << k;
      const Vector12 sigma = estimate.covariance.diagonal().cwiseSqrt();
      const Matrix12 off = (moments.covariance - estimate.covariance).cwiseQuotient(sigma * sigma.transpose());
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-9) << particles << " particles, frame " << k;
      for (const vo::BeliefComponent& component : odometry.Mixture())
        EXPECT_EQ(Eigen::LLT<Matrix12>(component.covariance).info(), Eigen::Success) << k;
    }
  }
}

}  // namespace
