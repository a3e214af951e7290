#include "sim/motion/spline.h"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "tests/unit/sim/motion_check.h"

namespace sim {
namespace {

using testing::HasSubstr;

std::vector<KeyPose> Flight() {
  const auto key = [](double t, glm::dvec3 p, glm::dvec3 phi) { return KeyPose{t, {p, Exp(phi)}}; };
  return {key(0, {0, 1, 2}, {0.1, 0, 0}), key(0.7, {0.5, 1.2, 1.7}, {0.3, 0.6, -0.1}),
          key(1.1, {0.6, 1.1, 1.5}, {0.2, 1.2, 0.1}), key(2.6, {-0.3, 0.8, 1}, {-0.2, 2.4, 0.3}),
          key(3, {-0.4, 0.8, 1.1}, {-0.2, 3.3, 0.3})};
}

TEST(Spline, PassesThroughEveryKey) {
  const SplineTrajectory spline(Flight());
  for (const KeyPose& key : Flight()) {
    const Pose pose = spline.At(key.t_s).pose;
    EXPECT_LT(glm::length(pose.p_WC - key.pose.p_WC), 1e-14);
    EXPECT_LT(glm::length(Log(glm::conjugate(pose.q_WC) * key.pose.q_WC)), 1e-14);
  }
  EXPECT_EQ(spline.end_s(), 3.0);
}

TEST(Spline, VelocitiesAreTheDerivativesOfThePose) {
  const SplineTrajectory spline(Flight());
  for (double t = -0.1; t < 3.1; t += 0.0317) {
    const RateErrors errors = RateErrorsAt(spline, t, 1e-3);
    // Away from the knots the differences are of fourth order; a knot's jump of the third derivative costs h^2.
    EXPECT_LT(errors.v, 1e-5) << t;
    EXPECT_LT(errors.w, 2e-5) << t;
    EXPECT_NEAR(glm::length(spline.At(t).pose.q_WC), 1, 1e-15);
  }
  for (const double t : {0.3, 0.9, 1.8, 2.8}) {
    const RateErrors errors = RateErrorsAt(spline, t, 1e-3);
    EXPECT_LT(errors.v, 1e-11) << t;
    EXPECT_LT(errors.w, 1e-9) << t;
    EXPECT_LT(errors.a, 1e-9) << t;
    EXPECT_LT(errors.alpha, 1e-8) << t;
  }
  // Linear extrapolation beyond the ends: the rate of the normalised quaternion still changes.
  for (const double t : {-0.05, 3.05}) {
    const RateErrors errors = RateErrorsAt(spline, t, 1e-3);
    EXPECT_LT(errors.a, 1e-9) << t;
    EXPECT_LT(errors.alpha, 1e-8) << t;
  }
}

TEST(Spline, AccelerationDoesNotJump) {
  const SplineTrajectory spline(Flight());
  constexpr double kStep = 1e-6;
  for (const KeyPose& key : Flight()) {  // the ends, too: beyond them velocity is constant
    const auto before = spline.At(key.t_s - kStep), at = spline.At(key.t_s), after = spline.At(key.t_s + kStep);
    EXPECT_LT(glm::length((after.v_WC - at.v_WC) - (at.v_WC - before.v_WC)) / kStep, 2e-4) << key.t_s;
    EXPECT_LT(glm::length((after.w_WC_C - at.w_WC_C) - (at.w_WC_C - before.w_WC_C)) / kStep, 2e-4) << key.t_s;
  }
}

TEST(Spline, StraightMotionStaysStraight) {
  std::vector<KeyPose> keys;
  for (const double t : {0.0, 0.2, 1.0, 1.5}) keys.push_back({t, {{1 + 2 * t, -t, 0.5 * t}, Exp({0.1, 0.2, 0.3})}});
  const SplineTrajectory spline(keys);
  for (double t = -0.2; t < 1.7; t += 0.05) {
    const Motion motion = spline.At(t);
    EXPECT_LT(glm::length(motion.pose.p_WC - glm::dvec3(1 + 2 * t, -t, 0.5 * t)), 1e-14);
    EXPECT_LT(glm::length(motion.v_WC - glm::dvec3(2, -1, 0.5)), 1e-14);
    EXPECT_LT(glm::length(motion.w_WC_C), 1e-14);
  }
}

// y'' = -3 in the middle, y(1/2) = 11/16, y'(0) = 3/2: the natural cubic through y = 0, 1, 0 at 0, 1, 2.
TEST(Spline, NaturalCubicByHand) {
  const SplineTrajectory spline(
      {{0, {{0, 0, 0}, {1, 0, 0, 0}}}, {1, {{0, 1, 0}, {1, 0, 0, 0}}}, {2, {{0, 0, 0}, {1, 0, 0, 0}}}});
  EXPECT_DOUBLE_EQ(spline.At(0.5).pose.p_WC.y, 11.0 / 16);
  EXPECT_DOUBLE_EQ(spline.At(0).v_WC.y, 1.5);
  EXPECT_NEAR(spline.At(1).v_WC.y, 0, 1e-15);
  EXPECT_DOUBLE_EQ(spline.At(-0.1).pose.p_WC.y, -0.15) << "beyond the ends along the tangent";
}

TEST(Spline, TwoKeysSixtyDegreesApart) {
  const double angle = std::acos(-1.0) / 3;
  const SplineTrajectory spline({{0, {}}, {1, {{0, 0, 0}, Exp({0, angle, 0})}}});
  EXPECT_NEAR(glm::length(Log(spline.At(0.5).pose.q_WC)), angle / 2, 1e-14);
  const double middle = spline.At(0.5).w_WC_C.y, end = spline.At(0).w_WC_C.y;
  EXPECT_NEAR(middle / end, 1 / std::pow(std::cos(angle / 4), 2), 1e-12) << "1.07, as the header says";
}

TEST(Spline, TheWorldFrameDoesNotMatter) {
  const Pose turn{{3, -2, 1}, Exp({0.4, -1.9, 0.7})};
  std::vector<KeyPose> moved = Flight();
  for (KeyPose& key : moved) key.pose = {turn.p_WC + turn.q_WC * key.pose.p_WC, turn.q_WC * key.pose.q_WC};
  const SplineTrajectory a(Flight()), b(moved);
  for (double t = 0; t < 3; t += 0.1) {
    const Motion x = a.At(t), y = b.At(t);
    EXPECT_LT(glm::length(y.pose.p_WC - (turn.p_WC + turn.q_WC * x.pose.p_WC)), 1e-14);
    EXPECT_LT(glm::length(Log(glm::conjugate(y.pose.q_WC) * (turn.q_WC * x.pose.q_WC))), 1e-14);
    EXPECT_LT(glm::length(y.v_WC - turn.q_WC * x.v_WC), 1e-13);
    EXPECT_LT(glm::length(y.w_WC_C - x.w_WC_C), 1e-13);
  }
}

TEST(Spline, TheQuaternionsSignDoesNotMatter) {
  std::vector<KeyPose> flipped = Flight();
  for (std::size_t k = 0; k < flipped.size(); k += 2) flipped[k].pose.q_WC = -flipped[k].pose.q_WC;
  const SplineTrajectory a(Flight()), b(flipped);
  for (double t = 0; t < 3; t += 0.1) EXPECT_LT(glm::length(a.At(t).w_WC_C - b.At(t).w_WC_C), 1e-14);
}

TEST(Spline, BadKeysAreAllNamed) {
  const auto message = [](const std::vector<KeyPose>& keys) {
    try {
      SplineTrajectory{keys};
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message({{0, {}}}), HasSubstr("at least two key poses"));
  EXPECT_EQ(message({{0, {}}, {1, {{0, 0, 0}, Exp({0, 2.2, 0})}}, {1, {{std::nan(""), 0, 0}, {}}}, {0.5, {}}}),
            "the camera turns by more than 120 deg between 0 s and 1 s: add a key pose between them; "
            "the key pose at 1 s is not finite or has no orientation; "
            "the key pose at 0.5 s comes after one at 1 s");
}

}  // namespace
}  // namespace sim
