#include "tools/bench/systems/prior.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vobench {
namespace {

evaluation::StampedPose SomePose() {
  return {5, {1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 2) / 3))};
}
evaluation::StampedVelocity SomeVelocity() { return {5, {0.5, -0.25, 1}, {0.1, 0.2, -0.3}}; }

// NEES of the velocity, summed over seeds: chi-square with 6 degrees of freedom per seed.
double Nees(int seeds, double claimed_over_drawn) {
  const PriorSettings settings{PriorSettings::Start::truth, 0.2, 0.05};
  double sum = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const vo::Prior prior = PriorFromTruth(settings, SomePose(), SomeVelocity(), static_cast<std::uint64_t>(seed));
    Eigen::Matrix<double, 6, 1> error;
    error << prior.v_WC - SomeVelocity().v_WC, prior.w_WC_C - SomeVelocity().w_WC_C;
    const vo::Matrix6 covariance = prior.velocity_covariance * claimed_over_drawn * claimed_over_drawn;
    sum += error.dot(covariance.inverse() * error);
  }
  return sum;
}

TEST(PriorTest, ThePoseIsTheTrueOne) {
  const vo::Prior prior = PriorFromTruth({}, SomePose(), SomeVelocity(), 7);
  EXPECT_EQ(prior.pose.p_WC, SomePose().p_WC);
  EXPECT_EQ(prior.pose.q_WC.coeffs(), SomePose().q_WC.coeffs());
  EXPECT_EQ(prior.pose_covariance.diagonal().maxCoeff(), kStartSigma * kStartSigma);
}

TEST(PriorTest, VelocityErrorHasItsCovariance) {
  // Chi-square with 6 * 1000 degrees of freedom: mean 6000, sigma 109.5. The band of 5 sigma is left once in 1.7
  // million.
  EXPECT_NEAR(Nees(1000, 1), 6000, 5 * std::sqrt(2 * 6000.0));
  // Control: sigmas 10 % below those of the draws.
  EXPECT_GT(Nees(1000, 0.9), 6000 + 5 * std::sqrt(2 * 6000.0));
}

TEST(PriorTest, IsAFunctionOfTheSeed) {
  const vo::Prior a = PriorFromTruth({}, SomePose(), SomeVelocity(), 7),
                  b = PriorFromTruth({}, SomePose(), SomeVelocity(), 7);
  EXPECT_EQ(a.v_WC, b.v_WC);
  EXPECT_EQ(a.w_WC_C, b.w_WC_C);
  EXPECT_NE(a.v_WC, PriorFromTruth({}, SomePose(), SomeVelocity(), 8).v_WC);
  EXPECT_NE(a.v_WC, PriorFromTruth({}, SomePose(), SomeVelocity(), 7 + (1ULL << 32)).v_WC) << "all 64 bits count";
}

// Velocity drawn by the scenario: the prior is centred on the mean of the distribution, not on the truth.
TEST(PriorTest, DrawnVelocityGivesTheMean) {
  sim::SampledMotion motion;
  motion.velocity = {1, 2, 3};
  motion.angular_rate = {4, 5, 6};
  const Truth start{{SomePose()}, evaluation::Velocities{SomeVelocity()}};
  const vo::Prior noisy = PriorFromTruth({}, SomePose(), SomeVelocity(), 7);
  EXPECT_EQ(PriorOf({}, motion, start, 7).v_WC, noisy.v_WC);
  EXPECT_EQ(PriorOf({}, motion, start, 7).w_WC_C, noisy.w_WC_C);
  motion.velocity_sigma = 0.3;
  EXPECT_EQ(PriorOf({}, motion, start, 7).v_WC, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(PriorOf({}, motion, start, 7).w_WC_C, noisy.w_WC_C);
  motion.angular_rate_sigma = 0.3;
  EXPECT_EQ(PriorOf({}, motion, start, 7).w_WC_C, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(PriorOf({}, motion, start, 7).pose.p_WC, SomePose().p_WC);
  EXPECT_TRUE(PriorOf({PriorSettings::Start::origin, 0.1, 0.1}, motion, start, 7).v_WC.isZero());
}

TEST(PriorTest, AtTheOriginNothingOfTheTruthIsKnown) {
  const vo::Prior prior = PriorAtOrigin({PriorSettings::Start::origin, 0.5, 0.25});
  EXPECT_TRUE(prior.pose.p_WC.isZero());
  EXPECT_EQ(prior.pose.q_WC.w(), 1);
  EXPECT_TRUE(prior.v_WC.isZero());
  EXPECT_TRUE(prior.w_WC_C.isZero());
  EXPECT_EQ(prior.velocity_covariance(0, 0), 0.25);
  EXPECT_EQ(prior.velocity_covariance(5, 5), 0.0625);
}

}  // namespace
}  // namespace vobench
