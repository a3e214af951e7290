#include "sim/motion/sampled.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/random/random.h"
#include "tests/unit/sim/motion_check.h"

namespace sim {
namespace {

constexpr double kChi2Of3 = 30.665;  // beyond it: 1e-6
constexpr double kZ = 4.8916;        // |z| beyond it: 1e-6, two-sided

using Pair = std::array<double, 2>;  // noises of position and velocity of one axis over one step

// Twice the log-likelihood ratio of the samples' own covariance to Q = [a b; b c]: chi-squared with three degrees of
// freedom for samples from N(0, Q).
double CovarianceScore(const std::vector<Pair>& samples, double a, double b, double c) {
  double s11 = 0, s12 = 0, s22 = 0;
  const double n = static_cast<double>(samples.size());
  for (const Pair& e : samples) {
    s11 += e[0] * e[0] / n;
    s12 += e[0] * e[1] / n;
    s22 += e[1] * e[1] / n;
  }
  const double det_q = a * c - b * b, det_s = s11 * s22 - s12 * s12;
  const double trace = (c * s11 - 2 * b * s12 + a * s22) / det_q;  // of Q^-1 S
  return n * (trace - std::log(det_s / det_q) - 2);
}

double NcvScore(const std::vector<Pair>& samples, double sigma, double dt) {
  const double s2 = sigma * sigma;
  return CovarianceScore(samples, s2 * dt * dt * dt / 3, s2 * dt * dt / 2, s2 * dt);
}

SampledMotion Free(double position_noise, double orientation_noise) {
  SampledMotion motion;
  motion.start = {{1, 2, 3}, Exp({0.3, -0.2, 0.5})};
  motion.velocity = {0.2, -0.1, 0.3};
  motion.angular_rate = {0.1, 0.2, -0.3};
  motion.position_noise = position_noise;
  motion.orientation_noise = orientation_noise;
  return motion;
}

// Process noise of the position between frames at 30 Hz (eight knots), through At.
std::vector<Pair> FrameNoises(const Trajectory& trajectory, int frames, double dt) {
  std::vector<Pair> noises;
  for (int k = 0; k < frames; ++k) {
    const Motion from = trajectory.At(k * dt), to = trajectory.At((k + 1) * dt);
    for (int axis = 0; axis < 3; ++axis) {
      noises.push_back(
          {to.pose.p_WC[axis] - from.pose.p_WC[axis] - dt * from.v_WC[axis], to.v_WC[axis] - from.v_WC[axis]});
    }
  }
  return noises;
}

// False alarms: 1e-6 for each of the three seeds.
TEST(Sampled, PositionNoiseBetweenFrames) {
  constexpr double kDt = 1.0 / 30, kSigma = 0.7;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SampledTrajectory trajectory(Free(kSigma, 0.4), seed, 500);
    const std::vector<Pair> noises = FrameNoises(trajectory, 15000, kDt);
    EXPECT_LT(NcvScore(noises, kSigma, kDt), kChi2Of3) << seed;
    // Controls: no correlation, three per cent more noise, five per cent more in the position are rejected.
    const double s2 = kSigma * kSigma;
    EXPECT_GT(CovarianceScore(noises, s2 * std::pow(kDt, 3) / 3, 0, s2 * kDt), kChi2Of3);
    EXPECT_GT(NcvScore(noises, 1.03 * kSigma, kDt), kChi2Of3);
    EXPECT_GT(CovarianceScore(noises, 1.05 * s2 * std::pow(kDt, 3) / 3, s2 * kDt * kDt / 2, s2 * kDt), kChi2Of3);
  }
}

// False alarms: 1e-6 for each of the three seeds.
TEST(Sampled, OrientationNoiseBetweenKnots) {
  constexpr double kSigma = 0.9;
  const SampledMotion motion = Free(0.3, kSigma);
  const double h = motion.knot_step_s;
  for (const std::uint64_t seed : {4, 5, 6}) {
    const SampledTrajectory trajectory(motion, seed, 60);
    std::vector<Pair> noises;
    for (std::size_t k = 0; k + 1 < trajectory.knots().size(); ++k) {
      const Motion &from = trajectory.knots()[k], &to = trajectory.knots()[k + 1];
      const glm::dvec3 turned = Log(glm::conjugate(from.pose.q_WC) * to.pose.q_WC) - h * from.w_WC_C;
      for (int axis = 0; axis < 3; ++axis) noises.push_back({turned[axis], to.w_WC_C[axis] - from.w_WC_C[axis]});
    }
    EXPECT_LT(NcvScore(noises, kSigma, h), kChi2Of3) << seed;
    EXPECT_GT(CovarianceScore(noises, kSigma * kSigma * h * h * h / 3, 0, kSigma * kSigma * h), kChi2Of3);
    EXPECT_GT(NcvScore(noises, 1.03 * kSigma, h), kChi2Of3);
  }
}

// Control: independent noises of position and velocity are rejected.
TEST(Sampled, UncorrelatedNoisesWouldBeNoticed) {
  constexpr double kDt = 1.0 / 30;
  std::vector<Pair> noises;
  for (std::uint32_t k = 0; k < 45000; ++k) {
    const auto z = Normals(RandomWords(1, Stream::position_noise, k, 0, 0));
    noises.push_back({std::sqrt(std::pow(kDt, 3) / 3) * z[0], std::sqrt(kDt) * z[1]});
  }
  EXPECT_GT(NcvScore(noises, 1, kDt), kChi2Of3);
}

// Noises of different steps, axes, and of position and orientation are uncorrelated. False alarms: 3e-6.
TEST(Sampled, NoisesOfStepsAndAxesAreIndependent) {
  const SampledMotion motion = Free(1, 1);
  const SampledTrajectory trajectory(motion, 9, 200);
  const auto& knots = trajectory.knots();
  double in_time = 0, across_axes = 0, with_orientation = 0;
  const double n = static_cast<double>(knots.size() - 2), scale = 1 / motion.knot_step_s;
  for (std::size_t k = 0; k + 2 < knots.size(); ++k) {
    const glm::dvec3 a = knots[k + 1].v_WC - knots[k].v_WC, b = knots[k + 2].v_WC - knots[k + 1].v_WC;
    in_time += a.x * b.x * scale / std::sqrt(n);
    across_axes += a.x * a.y * scale / std::sqrt(n);
    with_orientation += a.x * (knots[k + 1].w_WC_C.x - knots[k].w_WC_C.x) * scale / std::sqrt(n);
  }
  EXPECT_LT(std::abs(in_time), kZ);
  EXPECT_LT(std::abs(across_axes), kZ);
  EXPECT_LT(std::abs(with_orientation), kZ);
}

TEST(Sampled, VelocitiesAreDerivatives) {
  const SampledTrajectory trajectory(Free(2, 3), 5, 2);
  const double h = Free(2, 3).knot_step_s;
  for (int k = -1; k < 400; ++k) {
    for (const double u : {0.2, 0.5, 0.83}) {  // the differences stay between two knots
      const RateErrors errors = RateErrorsAt(trajectory, (k + u) * h, 0.05 * h);
      EXPECT_LT(errors.v, 1e-10) << k << " " << u;
      EXPECT_LT(errors.w, 1e-8) << k << " " << u;
      EXPECT_LT(errors.a, 1e-8) << k << " " << u;  // of up to 100 m/s^2
      EXPECT_LT(errors.alpha, 1e-6) << k << " " << u;
    }
  }
}

TEST(Sampled, PoseAndVelocityAreContinuousAtKnots) {
  const SampledTrajectory trajectory(Free(2, 3), 6, 2);
  const double h = Free(2, 3).knot_step_s;
  for (int k = 0; k < 480; ++k) {
    const Motion before = trajectory.At(k * h - 1e-9), after = trajectory.At(k * h + 1e-9);
    const Motion& knot = trajectory.knots()[static_cast<std::size_t>(k)];
    EXPECT_LT(glm::length(after.pose.p_WC - before.pose.p_WC), 1e-7);
    EXPECT_LT(glm::length(after.v_WC - before.v_WC), 1e-5);
    EXPECT_LT(glm::length(after.w_WC_C - before.w_WC_C), 1e-5);
    EXPECT_LT(glm::length(after.w_WC_C - knot.w_WC_C), 1e-5) << "the knot's is the true angular velocity";
    EXPECT_LT(glm::length(after.v_WC - knot.v_WC), 1e-5);
  }
}

TEST(Sampled, WithoutNoiseVelocityIsConstant) {
  const SampledMotion motion = Free(0, 0);
  const SampledTrajectory trajectory(motion, 1, 3);
  for (const double t : {-0.01, 0.0, 0.123, 1.0, 3.0}) {
    const Motion at = trajectory.At(t);
    EXPECT_LT(glm::length(at.pose.p_WC - (motion.start.p_WC + t * motion.velocity)), 1e-12) << t;
    EXPECT_LT(glm::length(Log(glm::conjugate(at.pose.q_WC) * (motion.start.q_WC * Exp(t * motion.angular_rate)))),
              1e-12)
        << t;
    EXPECT_LT(glm::length(at.v_WC - motion.velocity), 1e-12);
    EXPECT_LT(glm::length(at.w_WC_C - motion.angular_rate), 1e-12);
  }
}

TEST(Sampled, AFunctionOfSeedAndTimeAlone) {
  const SampledTrajectory a(Free(1, 1), 7, 2), longer(Free(1, 1), 7, 20), other(Free(1, 1), 8, 2);
  for (double t = 0; t <= 2; t += 0.01) {
    EXPECT_EQ(a.At(t).pose.p_WC, longer.At(t).pose.p_WC);
    EXPECT_EQ(a.At(t).pose.q_WC, longer.At(t).pose.q_WC);
    EXPECT_EQ(a.At(t).w_WC_C, longer.At(t).w_WC_C);
  }
  EXPECT_GT(glm::length(a.At(2).pose.p_WC - other.At(2).pose.p_WC), 0.01);
}

// sigma / (2 r^1.5) and sigma / (2 r^0.5): standard deviations of position and velocity on a long flight with return
// rate r. With about 2 r T / 2 = 4000 independent values and 3 axes their relative error is below 1.1 per cent; the
// bound is five times that, plus one per cent for a return that is constant over a step (r h = 0.8 per cent).
TEST(Sampled, ReturnKeepsTheCameraNearItsStart) {
  SampledMotion motion = Free(1, 0.5);
  motion.velocity = motion.angular_rate = glm::dvec3(0);
  motion.position_return = motion.orientation_return = 2;
  const SampledTrajectory trajectory(motion, 11, 4000);
  double p2 = 0, v2 = 0, phi2 = 0, w2 = 0;
  const double n = 3.0 * static_cast<double>(trajectory.knots().size());
  for (const Motion& knot : trajectory.knots()) {
    const glm::dvec3 p = knot.pose.p_WC - motion.start.p_WC;
    const glm::dvec3 phi = Log(glm::conjugate(motion.start.q_WC) * knot.pose.q_WC);
    p2 += glm::dot(p, p) / n;
    v2 += glm::dot(knot.v_WC, knot.v_WC) / n;
    phi2 += glm::dot(phi, phi) / n;
    w2 += glm::dot(knot.w_WC_C, knot.w_WC_C) / n;
  }
  constexpr double kBound = 0.065;
  EXPECT_NEAR(std::sqrt(p2) / (1 / (2 * std::pow(2, 1.5))), 1, kBound);
  EXPECT_NEAR(std::sqrt(v2) / (1 / (2 * std::pow(2, 0.5))), 1, kBound);
  EXPECT_NEAR(std::sqrt(phi2) / (0.5 / (2 * std::pow(2, 1.5))), 1, kBound);
  EXPECT_NEAR(std::sqrt(w2) / (0.5 / (2 * std::pow(2, 0.5))), 1, kBound);
}

// Mean and standard deviation of the start velocities over seeds. Chi-squared with 6 * 2000 degrees of freedom: 12000,
// sigma 155; two-sided false-alarm rate at five sigma 1 in 1.7 million.
TEST(Sampled, StartVelocitiesAreDrawnAboutTheGivenOnes) {
  SampledMotion motion = Free(1, 1);
  motion.velocity_sigma = 0.2;
  motion.angular_rate_sigma = 0.05;
  const auto sum_of_squares = [&](double claimed_v, double claimed_w) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      const Motion first = SampledTrajectory(motion, seed, 0.01).knots().front();
      const glm::dvec3 v = (first.v_WC - motion.velocity) / claimed_v;
      const glm::dvec3 w = (first.w_WC_C - motion.angular_rate) / claimed_w;
      sum += glm::dot(v, v) + glm::dot(w, w);
    }
    return sum;
  };
  EXPECT_NEAR(sum_of_squares(0.2, 0.05), 12000, 775);
  EXPECT_GT(std::abs(sum_of_squares(0.18, 0.05) - 12000), 775) << "ten per cent less in one of the two is rejected";
  EXPECT_GT(std::abs(sum_of_squares(0.2, 0.055) - 12000), 775);
  // Zero standard deviation: the given velocity.
  EXPECT_EQ(SampledTrajectory(Free(1, 1), 3, 0.01).knots().front().v_WC, Free(1, 1).velocity);
}

// Log(R_1 ... R_n) - sum Log(R_i), the remainder of a filter's additive model of orientation between frames at 30 Hz,
// in standard deviations of the model's noise. Rotations do not commute: knots of 1/240 s leave a small remainder;
// knots at the frames leave rounding alone.
TEST(Sampled, FinerKnotsAtFrames) {
  constexpr double kSigma = 0.5, kFrame = 1.0 / 30;
  const auto remainder = [&](int knots_per_frame) {
    SampledMotion motion = Free(0.5, kSigma);
    motion.knot_step_s = kFrame / knots_per_frame;
    const SampledTrajectory trajectory(motion, 12, 10);
    const auto& knots = trajectory.knots();
    const std::size_t n = static_cast<std::size_t>(knots_per_frame);
    double sum = 0;
    for (std::size_t k = 0; k + n < knots.size(); k += n) {
      glm::dvec3 increments(0);
      for (std::size_t i = k; i < k + n; ++i)
        increments += Log(glm::conjugate(knots[i].pose.q_WC) * knots[i + 1].pose.q_WC);
      const glm::dvec3 e = Log(glm::conjugate(knots[k].pose.q_WC) * knots[k + n].pose.q_WC) - increments;
      sum += glm::dot(e, e) / 3 / 300;
    }
    return std::sqrt(sum) / (kSigma * std::sqrt(kFrame * kFrame * kFrame / 3));
  };
  EXPECT_LT(remainder(1), 1e-10);
  EXPECT_GT(remainder(8), 1e-4);
  EXPECT_LT(remainder(8), 1e-2);
  RecordProperty("remainder_of_the_noise", std::to_string(remainder(8)));
}

TEST(Sampled, BadSettingsAreAllNamed) {
  SampledMotion motion;
  motion.position_noise = -1;
  motion.orientation_noise = std::nan("");
  motion.position_return = 1000;
  motion.start.q_WC = {0, 0, 0, 0};
  try {
    SampledTrajectory(motion, 1, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "sampled motion: position_noise = -1 m/s^1.5 must be at least 0 m/s^1.5; "
                 "orientation_noise = nan rad/s^1.5 must be at least 0 rad/s^1.5; "
                 "position_return = 1000 must not be above 0.2 / knot_step; start is no pose");
  }
}

// Soft walls: a minute of motion stays inside the box, which it leaves by metres without walls. The two motions are
// equal until the first one reaches a wall's margin.
TEST(Sampled, SoftWallsKeepItInABox) {
  SampledMotion motion;
  motion.position_noise = 0.3;
  motion.walls = SoftWalls{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, 0.75, 4};
  double farthest = 0, free = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SampledTrajectory kept(motion, seed, 60);
    SampledMotion without = motion;
    without.walls.reset();
    const SampledTrajectory loose(without, seed, 60);
    bool touched = false;
    for (std::size_t k = 0; k < kept.knots().size(); ++k) {
      const glm::dvec3 &p = kept.knots()[k].pose.p_WC, &q = loose.knots()[k].pose.p_WC;
      const double size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      farthest = std::max(farthest, size);
      free = std::max(free, glm::length(q));
      if (!touched) {
        ASSERT_EQ(p, q);
      }
      touched = touched || size > 0.75;
      inside += size < 1;
    }
  }
  EXPECT_LT(farthest, 1.5);
  EXPECT_GT(free, 20);
  EXPECT_GT(inside, 1000) << "it moves about, not along the walls only";
  motion.walls->margin = 2;
  EXPECT_THROW(SampledTrajectory(motion, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace sim
