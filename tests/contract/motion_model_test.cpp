// Nearly-constant-velocity model: the odometry's matrices against a worked example, and the simulator's sampled motion
// against these matrices. "position_noise: 2 m/s^1.5" has the same meaning in both.
#include "vo/filter/motion_model.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "sim/motion/sampled.h"
#include "vo/geometry/so3.h"

namespace {

constexpr double kPositionNoise = 2, kOrientationNoise = 3;

vo::MotionParams Params() {
  vo::MotionParams params;
  params.position_noise = kPositionNoise;
  params.orientation_noise = kOrientationNoise;
  return params;
}

// Size and correlation time of a first-order Gauss-Markov velocity: its steps have this density and keep this variance.
TEST(MotionModelContract, AVelocityThatDecaysKeepsItsSize) {
  constexpr double kTime = 0.7, kDt = 1e-4;
  constexpr double kDensity = kPositionNoise * kPositionNoise;
  constexpr double kVariance = kDensity * kTime / 2;  // per axis
  EXPECT_NEAR(vo::VelocityTime(Eigen::Vector3d::Constant(std::sqrt(kVariance)), kDensity), kTime, 1e-12);
  const vo::MotionModel model =
      vo::NearlyConstantVelocity(Params(), kDt, {.coasting_s = kDt, .position_time = kTime, .orientation_time = 0.2});
  const double decay = model.F(6, 6);
  EXPECT_NEAR(decay * decay * kVariance + model.Q(6, 6), kVariance, 1e-6 * kVariance);
  EXPECT_NEAR(model.F(9, 9), std::exp(-kDt / 0.2), 1e-15);
  EXPECT_NEAR(model.F(3, 9), 0.2 * (1 - model.F(9, 9)), 1e-15);
  EXPECT_EQ(vo::VelocityTime({1e-9, 0, 0}, 1), vo::kLeastVelocityTime);
  EXPECT_EQ(vo::VelocityTime({1e9, 0, 0}, 1), vo::kMostVelocityTime);
}

TEST(MotionModelContract, AsWorkedByHand) {
  // dt = 0.5: dt^3/3 = 1/24, dt^2/2 = 1/8, dt = 1/2, times 4 and times 9.
  const vo::MotionModel model = vo::NearlyConstantVelocity(Params(), 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    const int p = axis, delta = 3 + axis, v = 6 + axis, w = 9 + axis;
    EXPECT_NEAR(model.Q(p, p), 1.0 / 6, 1e-15);
    EXPECT_NEAR(model.Q(p, v), 0.5, 1e-15);
    EXPECT_NEAR(model.Q(v, v), 2.0, 1e-15);
    EXPECT_NEAR(model.Q(delta, delta), 0.375, 1e-15);
    EXPECT_NEAR(model.Q(delta, w), 1.125, 1e-15);
    EXPECT_NEAR(model.Q(w, w), 4.5, 1e-15);
    EXPECT_NEAR(model.F(p, v), 0.5, 1e-15);
    EXPECT_NEAR(model.F(delta, w), 0.5, 1e-15);
  }
  EXPECT_EQ((model.Q - model.Q.transpose()).norm(), 0);
}

Eigen::Vector3d ToEigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Eigen::Quaterniond ToEigen(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }

// Process noise of the simulator's motion, from knot to knot, in the odometry's order (p, delta, v, w).
std::vector<Eigen::Matrix<double, 12, 1>> Innovations(double step) {
  sim::SampledMotion motion;
  motion.position_noise = kPositionNoise;
  motion.orientation_noise = kOrientationNoise;
  motion.knot_step_s = step;
  const sim::SampledTrajectory trajectory(motion, 20240607, 8.0);
  std::vector<Eigen::Matrix<double, 12, 1>> all;
  const std::vector<sim::Motion>& knots = trajectory.knots();
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const sim::Motion &a = knots[k], &b = knots[k + 1];
    Eigen::Matrix<double, 12, 1> n;
    n << ToEigen(b.pose.p_WC - a.pose.p_WC - step * a.v_WC),
        vo::Log(ToEigen(a.pose.q_WC).conjugate() * ToEigen(b.pose.q_WC)) - step * ToEigen(a.w_WC_C),
        ToEigen(b.v_WC - a.v_WC), ToEigen(b.w_WC_C - a.w_WC_C);
    all.push_back(n);
  }
  return all;
}

// Sum of n' Q^-1 n minus its expectation, in standard deviations. Chi-square, nearly normal.
double Surprise(const std::vector<Eigen::Matrix<double, 12, 1>>& innovations, const vo::Matrix12& Q) {
  const Eigen::LLT<vo::Matrix12> factor(Q);
  double sum = 0;
  for (const auto& n : innovations) sum += n.dot(factor.solve(n));
  const double dof = 12.0 * static_cast<double>(innovations.size());
  return (sum - dof) / std::sqrt(2 * dof);
}

TEST(MotionModelContract, TheSimulatorsMotionIsTheOdometrysModel) {
  const double step = 1.0 / 240;
  const auto innovations = Innovations(step);
  ASSERT_GE(innovations.size(), 1900U);
  const vo::Matrix12 Q = vo::NearlyConstantVelocity(Params(), step).Q;
  EXPECT_LT(std::abs(Surprise(innovations, Q)), 5);  // false-alarm rate: one in 1.7 million
  // Controls: a spectral density off by 10 %, and sigma^2 in the place of sigma.
  EXPECT_GT(std::abs(Surprise(innovations, 1.1 * Q)), 5);
  EXPECT_GT(std::abs(Surprise(innovations, 0.9 * Q)), 5);
  vo::MotionParams squared = Params();
  squared.position_noise = kPositionNoise * kPositionNoise;
  EXPECT_GT(std::abs(Surprise(innovations, vo::NearlyConstantVelocity(squared, step).Q)), 5);
}

// Correlation of position noise and velocity noise: without it the sum above can be within its limit. It is sqrt(3)/2 =
// 0.866 in the model, and estimated here with a standard deviation of (1 - 0.75) / sqrt(3 * 1920) = 0.0033.
TEST(MotionModelContract, PositionAndVelocityNoiseAreCorrelated) {
  const auto innovations = Innovations(1.0 / 240);
  vo::Matrix12 covariance = vo::Matrix12::Zero();
  for (const auto& n : innovations) covariance += n * n.transpose();
  for (int half = 0; half < 2; ++half) {
    double correlation = 0;
    for (int axis = 3 * half; axis < 3 * half + 3; ++axis) {
      correlation +=
          covariance(axis, axis + 6) / std::sqrt(covariance(axis, axis) * covariance(axis + 6, axis + 6)) / 3;
    }
    EXPECT_NEAR(correlation, std::sqrt(0.75), 5 * 0.0033);
  }
}

}  // namespace
