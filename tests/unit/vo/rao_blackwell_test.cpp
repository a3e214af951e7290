// Rao-Blackwell steps against the joint Gaussian of pose and velocity, conditioned by Bayes' rule.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/unit/vo/draws.h"
#include "vo/filter/particle_set.h"
#include "vo/filter/velocity_filter.h"
#include "vo/geometry/so3.h"

namespace {

using vo::Matrix12;
using vo::Matrix6;
using vo::Vector6;

constexpr double kDt = 0.04;
const vo::MotionParams kMotion{.position_noise = 2.5, .orientation_noise = 1};

vo::Particle MakeParticle(unsigned seed) {
  vo_test::Draws draws(seed);
  vo::Particle particle;
  particle.pose = {draws.Normals<3>(), vo::Exp(draws.Normals<3>())};
  const Matrix6 root = 0.3 * Matrix6::Identity() + 0.1 * draws.Normals<36>().reshaped(6, 6);
  particle.velocity = {draws.Normals<6>(), root * root.transpose()};
  return particle;
}

// Joint Gaussian of (p, delta, v, w) after one step.
struct Joint {
  Eigen::Matrix<double, 12, 1> mean;
  Matrix12 covariance;
};
Joint JointAfterAStep(const vo::Particle& particle) {
  const vo::MotionModel model = vo::NearlyConstantVelocity(kMotion, kDt);
  Eigen::Matrix<double, 12, 1> state;
  state << particle.pose.p_WC, Eigen::Vector3d::Zero(), particle.velocity.mean;
  Matrix12 P = Matrix12::Zero();
  P.bottomRightCorner<6, 6>() = particle.velocity.covariance;
  return {model.F * state, model.F * P * model.F.transpose() + model.Q};
}

TEST(RaoBlackwell, PredictionIsTheMarginalOfThePose) {
  const vo::Particle particle = MakeParticle(1);
  const vo::VelocityFilter step(kMotion, kDt);
  const vo::PoseGaussian predicted =
      vo::PredictPose(step, particle.pose, particle.velocity, step.PredictedCovariance(particle.velocity));
  const Joint joint = JointAfterAStep(particle);
  EXPECT_LT((predicted.mean.p_WC - joint.mean.head<3>()).norm(), 1e-12);
  const Eigen::Vector3d delta = vo::Log(particle.pose.q_WC.conjugate() * predicted.mean.q_WC);
  EXPECT_LT((delta - joint.mean.segment<3>(3)).norm(), 1e-12);
  EXPECT_LT((vo::PredictedTurn(step, particle.pose, particle.velocity) - delta).norm(), 1e-12);
  Matrix6 J = Matrix6::Identity();  // from delta to the tangent space at the mean
  J.bottomRightCorner<3, 3>() = vo::RightJacobian(delta);
  const Matrix6 expected = J * joint.covariance.topLeftCorner<6, 6>() * J.transpose();
  EXPECT_LT((predicted.covariance - expected).norm(), 1e-12 * expected.norm());
}

// (37)-(43): velocity conditional on the pose. Control: without the correlation of the process noise, the paper's
// subject, the mean differs.
TEST(RaoBlackwell, VelocityIsTheConditionalGivenThePose) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const vo::Particle particle = MakeParticle(seed);
    const vo::VelocityFilter step(kMotion, kDt);
    const Eigen::Vector3d turn = vo::PredictedTurn(step, particle.pose, particle.velocity);
    vo_test::Draws draws(100 + seed);
    const Joint joint = JointAfterAStep(particle);
    const Vector6 s = joint.mean.head<6>() + 0.02 * draws.Normals<6>();
    const vo::Pose sampled{s.head<3>(), particle.pose.q_WC * vo::Exp(s.tail<3>())};
    const auto conditional = [&](const Matrix12& covariance) {
      const Matrix6 gain = covariance.topLeftCorner<6, 6>().llt().solve(covariance.topRightCorner<6, 6>()).transpose();
      return vo::VelocityFilter::State{joint.mean.tail<6>() + gain * (s - joint.mean.head<6>()),
                                       covariance.bottomRightCorner<6, 6>() - gain * covariance.topRightCorner<6, 6>()};
    };
    const vo::VelocityFilter::State expected = conditional(joint.covariance);
    const vo::VelocityFilter::State found = vo::VelocityGivenPose(
        step.Condition(vo::PathState(particle.pose), particle.velocity), particle.pose, sampled, turn);
    EXPECT_LT((found.mean - expected.mean).norm(), 1e-9) << seed;
    EXPECT_LT((found.covariance - expected.covariance).norm(), 1e-9) << seed;
    Matrix12 uncorrelated = joint.covariance;
    const vo::MotionModel model = vo::NearlyConstantVelocity(kMotion, kDt);
    uncorrelated.topRightCorner<6, 6>() -= model.Q.topRightCorner<6, 6>();
    EXPECT_GT((found.mean - conditional(uncorrelated).mean).norm(), 1e-3) << seed;
  }
}

// Step of more than half a turn, read as the rotation vector next to the predicted one.
TEST(RaoBlackwell, VelocityFollowsARotationOfMoreThanHalfATurn) {
  vo::Particle particle;
  particle.velocity = {Vector6::Unit(5) * 4.0, 0.01 * Matrix6::Identity()};
  const vo::VelocityFilter step(kMotion, 1.0);
  const vo::Pose sampled{{0, 0, 0}, vo::Exp({0, 0, 4.0})};
  const vo::VelocityFilter::State velocity =
      vo::VelocityGivenPose(step.Condition(vo::PathState(particle.pose), particle.velocity), particle.pose, sampled,
                            vo::PredictedTurn(step, particle.pose, particle.velocity));
  EXPECT_NEAR(velocity.mean[5], 4.0, 1e-9);
}

}  // namespace
