// Poses and angular rates of docs/conventions.md: worked examples in the simulator and in the odometry, and the
// simulator's motion in the odometry's terms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/motion/sampled.h"
#include "sim/motion/so3.h"
#include "sim/motion/spline.h"
#include "vo/filter/motion_model.h"
#include "vo/geometry/so3.h"

namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d ToEigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Eigen::Quaterniond ToEigen(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }

// A quarter turn about z takes x to y: Hamilton. (In the other convention, JPL, it would take x to -y.)
TEST(RotationContract, AQuarterTurnAboutZTakesXToY) {
  const double h = std::sqrt(0.5);
  const Eigen::Quaterniond a = vo::Exp({0, 0, kPi / 2});
  EXPECT_NEAR(a.w(), h, 1e-15);
  EXPECT_NEAR(a.z(), h, 1e-15);
  EXPECT_NEAR(((a * Eigen::Vector3d(1, 0, 0)) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-15);
  const glm::dquat b = sim::Exp({0, 0, kPi / 2});
  EXPECT_NEAR(b.w, h, 1e-15);
  EXPECT_NEAR(b.z, h, 1e-15);
  EXPECT_NEAR(glm::length(b * glm::dvec3(1, 0, 0) - glm::dvec3(0, 1, 0)), 0, 1e-15);
}

// q_WC: 90 degrees about z, then 90 degrees about the rotated x. By hand: (1 + k)/sqrt2 (1 + i)/sqrt2 = (1 + i + k +
// ki)/2 = (1 + i + j + k)/2, since ki = j.
TEST(RotationContract, ProductsAreHamiltons) {
  const Eigen::Quaterniond a = vo::Exp({0, 0, kPi / 2}) * vo::Exp({kPi / 2, 0, 0});
  EXPECT_NEAR((a.coeffs() - Eigen::Vector4d(0.5, 0.5, 0.5, 0.5)).norm(), 0, 1e-15);
  const glm::dquat b = sim::Exp({0, 0, kPi / 2}) * sim::Exp({kPi / 2, 0, 0});
  EXPECT_NEAR((ToEigen(b).coeffs() - Eigen::Vector4d(0.5, 0.5, 0.5, 0.5)).norm(), 0, 1e-15);
}

TEST(RotationContract, ExponentialsAndLogarithmsAgree) {
  for (const double angle : {0.0, 1e-9, 1e-5, 1e-3, 0.5, 3.0}) {
    const Eigen::Vector3d phi = angle * Eigen::Vector3d(2, -1, 2) / 3;
    const Eigen::Quaterniond a = vo::Exp(phi);
    const glm::dquat b = sim::Exp({phi.x(), phi.y(), phi.z()});
    EXPECT_NEAR((a.coeffs() - ToEigen(b).coeffs()).norm(), 0, 1e-15) << angle;
    EXPECT_NEAR((vo::Log(ToEigen(b)) - phi).norm(), 0, 1e-14) << angle;
    EXPECT_NEAR((ToEigen(sim::Log({a.w(), a.x(), a.y(), a.z()})) - phi).norm(), 0, 1e-14) << angle;
  }
}

sim::SplineTrajectory SomeMotion() {
  return sim::SplineTrajectory({{0, {{0, 0, 0}, sim::Exp({0, 0, 0})}},
                                {1, {{0.5, -0.2, 0.3}, sim::Exp({0.3, -0.5, 0.2})}},
                                {2, {{0.6, 0.2, 0.9}, sim::Exp({-0.2, 0.4, 0.6})}}});
}

// q(t + dt) = q(t) (x) Exp(w dt): the simulator's angular rate against a central difference with the odometry's
// logarithm. Control: the rate taken in W.
TEST(RotationContract, TheSimulatorsRatesAreInTheCameraFrame) {
  const sim::SplineTrajectory motion = SomeMotion();
  const double dt = 1e-4;
  double in_camera = 0, in_world = 0;
  for (double t = 0.1; t < 1.95; t += 0.1) {
    const sim::Motion before = motion.At(t - dt), now = motion.At(t), after = motion.At(t + dt);
    const Eigen::Quaterniond q = ToEigen(now.pose.q_WC);
    const Eigen::Vector3d w = vo::Log(ToEigen(before.pose.q_WC).conjugate() * ToEigen(after.pose.q_WC)) / (2 * dt);
    in_camera = std::max(in_camera, (w - ToEigen(now.w_WC_C)).norm());
    in_world = std::max(in_world, (w - q * ToEigen(now.w_WC_C)).norm());
    const Eigen::Vector3d v = ToEigen(after.pose.p_WC - before.pose.p_WC) / (2 * dt);
    EXPECT_NEAR((v - ToEigen(now.v_WC)).norm(), 0, 1e-6);
  }
  EXPECT_LT(in_camera, 1e-6);  // dt^2 / 6 times the third derivative, a few rad/s^3
  EXPECT_GT(in_world, 0.01);
}

}  // namespace
