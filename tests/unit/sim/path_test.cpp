#include "sim/motion/path.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/motion/trajectory.h"
#include "sim/scenario/scenario.h"
#include "tests/unit/sim/motion_check.h"
#include "tests/unit/sim/small_world.h"
#include "tools/base/settings/problem.h"

namespace sim {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

// The scenario's motion with this trajectory, through the reader.
MotionDescription Read(const std::string& trajectory, const std::string& duration = "10 s") {
  const SmallWorld world;
  return LoadScenario(world.scenario(), {{"trajectory", trajectory}, {"time.duration", duration}}).motion;
}
PathMotion ReadPath(const std::string& trajectory) { return std::get<PathMotion>(Read(trajectory)); }

PathMotion Everything() {
  PathMotion motion;
  motion.start = {{1, 0.4, -0.7}, Exp({0.3, -0.2, 1.1})};
  motion.pivot = {0.2, 0.1, 0.5};
  motion.azimuth = {Swing::Kind::steady, 2 * kPi, 7};
  motion.elevation = {Swing::Kind::there_and_back, 1.1, 3};
  motion.yaw = {Swing::Kind::about, 0.4, 2};
  motion.pitch = {Swing::Kind::about, 0.3, 1.7};
  motion.roll = {Swing::Kind::there_and_back, -0.5, 1.3};
  motion.move = {0.3, -0.2, 0.5};
  motion.along = {Swing::Kind::about, 1.5, 2.9};
  return motion;
}

TEST(Path, RatesAndAccelerationsAreTheDerivatives) {
  const PathTrajectory path(Everything());
  for (double t = -0.1; t < 9; t += 0.173) {
    const RateErrors errors = RateErrorsAt(path, t, 1e-3);
    EXPECT_LT(errors.v, 1e-9) << t;
    EXPECT_LT(errors.w, 1e-9) << t;
    EXPECT_LT(errors.a, 1e-8) << t;
    EXPECT_LT(errors.alpha, 1e-8) << t;
    EXPECT_NEAR(glm::length(path.At(t).pose.q_WC), 1, 1e-14);
  }
  EXPECT_EQ(path.At(0).pose.p_WC, Everything().start.p_WC);
}

// Orbit about the y axis: a quarter turn takes +z to +x; the centre stays on the optical axis.
TEST(Path, OrbitByHand) {
  const PathTrajectory orbit(
      ReadPath("{type: orbit, start: {position: [0, 1, 3], look_at: [0, 1, 0]}, center: [0, 1, 0], period: 8 s}"));
  EXPECT_LT(glm::length(orbit.At(2).pose.p_WC - glm::dvec3(3, 1, 0)), 1e-12);
  EXPECT_LT(glm::length(orbit.At(8).pose.p_WC - glm::dvec3(0, 1, 3)), 1e-12);
  for (double t = 0; t < 8; t += 0.7) {
    const Motion at = orbit.At(t);
    EXPECT_LT(glm::length(at.pose.p_WC + 3.0 * (at.pose.q_WC * glm::dvec3(0, 0, 1)) - glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_NEAR(glm::length(at.v_WC), 3 * 2 * kPi / 8, 1e-12);
    EXPECT_LT(glm::length(at.w_WC_C - glm::dvec3(0, -2 * kPi / 8, 0)), 1e-12) << "about -y of C, which is up";
    EXPECT_NEAR(glm::length(at.a_WC), 3 * std::pow(2 * kPi / 8, 2), 1e-12);
    EXPECT_LT(glm::length(at.alpha_WC_C), 1e-12);
  }
}

TEST(Path, HalfSphereStaysOnItAndLooksAtItsMiddle) {
  const PathTrajectory path(
      ReadPath("{type: half_sphere, start: {position: [0, 0, 2], look_at: [0, 0, 0]}, center: [0, 0, 0], sweep: 120 "
               "deg, period: 5 s, rise: 60 deg, rise_period: 8 s}"));
  double highest = 0, widest = 0;
  for (double t = 0; t < 40; t += 0.01) {
    const Motion at = path.At(t);
    EXPECT_NEAR(glm::length(at.pose.p_WC), 2, 1e-12);
    EXPECT_LT(glm::length(at.pose.p_WC + 2.0 * (at.pose.q_WC * glm::dvec3(0, 0, 1))), 1e-12);
    EXPECT_GE(at.pose.p_WC.y, -1e-12);
    highest = std::max(highest, at.pose.p_WC.y);
    widest = std::max(widest, std::atan2(at.pose.p_WC.x, at.pose.p_WC.z));
  }
  EXPECT_NEAR(highest, 2 * std::sin(kPi / 3), 1e-4);
  EXPECT_NEAR(widest, kPi / 3, 1e-4);
}

TEST(Path, TurnsOnTheSpotAndDolly) {
  const PathTrajectory rpy(
      ReadPath("{type: rpy, start: {position: [1, 2, 3], look_at: [1, 2, 0]}, angles: [10 deg, 20 deg, 30 deg], "
               "periods: [3 s, 4 s, 5 s]}"));
  for (double t = 0; t < 9; t += 0.3) EXPECT_EQ(rpy.At(t).pose.p_WC, glm::dvec3(1, 2, 3));
  const Motion start = rpy.At(0);
  const double degree = kPi / 180;
  EXPECT_LT(glm::length(start.w_WC_C - 2 * kPi * degree * glm::dvec3(20.0 / 4, 30.0 / 5, 10.0 / 3)), 1e-12);

  const PathTrajectory dolly(
      ReadPath("{type: dolly, start: {position: [1, 2, 3], look_at: [1, 2, 0]}, move: [0, 0, -2], period: 4 s}"));
  EXPECT_LT(glm::length(dolly.At(2).pose.p_WC - glm::dvec3(1, 2, 1)), 1e-12);
  EXPECT_LT(glm::length(dolly.At(1).v_WC - glm::dvec3(0, 0, -kPi / 2)), 1e-12);
  EXPECT_EQ(glm::length(dolly.At(1).w_WC_C), 0);
}

TEST(Path, SpeedIsTheMean) {
  const std::string dolly =
      "type: dolly, start: {position: [0, 0, 0], look_at: [0, 0, -2]}, move: [0, 0, -2], period: 4 s";
  EXPECT_NEAR(MeanSpeed(PathTrajectory(ReadPath("{" + dolly + "}")), 4), 1, 1e-6) << "4 m in 4 s";
  const PathMotion faster = ReadPath("{" + dolly + ", speed: 2.5 m/s}");
  EXPECT_NEAR(faster.along.period_s, 4 / 2.5, 1e-6);
  EXPECT_NEAR(MeanSpeed(PathTrajectory(faster), faster.along.period_s), 2.5, 1e-6);
  EXPECT_NEAR(
      ReadPath(
          "{type: orbit, start: {position: [0, 1, 3], look_at: [0, 1, 0]}, center: [0, 1, 0], period: 8 s, speed: 1}")
          .azimuth.period_s,
      6 * kPi, 1e-9);
  // A script of 2 m in 4 s, flown at twice its speed, ends after 2 s.
  const std::string script =
      "type: scripted, keys: [{time: 0, position: [0, 0, 0], look_at: [0, 0, -2]}, {time: 4, position: [2, 0, 0], "
      "look_at: [2, 0, -2]}]";
  const auto keys = std::get<ScriptedMotion>(Read("{" + script + ", speed: 1 m/s}", "1 s")).keys;
  EXPECT_NEAR(keys.back().t_s, 2, 1e-9);
}

TEST(Path, WhatIsWrongIsSaid) {
  const auto message = [](const std::string& trajectory) {
    try {
      Read(trajectory);
    } catch (const settings::Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string start = "start: {position: [0, 1, 3], look_at: [0, 1, 0]}";
  EXPECT_THAT(message("{type: orbit, " + start + "}"), testing::AllOf(HasSubstr("center"), HasSubstr("period")));
  EXPECT_THAT(message("{type: half_sphere, start: {position: [0, 1, 0], look_at: [1, 1, 0]}, center: [0, 0, 0], sweep: "
                      "1, period: 1, rise: 1, rise_period: 1}"),
              HasSubstr("straight above"));
  EXPECT_THAT(message("{type: rpy, " + start + ", angles: [1, 1, 1], periods: [1, 1, 1], speed: 1}"),
              HasSubstr("'speed': the path does not move"));
  EXPECT_THAT(message("{type: dolly, " + start + ", move: [1, 0, 0], period: 0 s}"), HasSubstr("period"));
  EXPECT_THAT(message("{type: orbits}"), HasSubstr("orbit"));
}

}  // namespace
}  // namespace sim
