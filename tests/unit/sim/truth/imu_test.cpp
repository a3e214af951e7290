#include "sim/motion/imu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/motion/sampled.h"
#include "sim/motion/so3.h"
#include "sim/motion/spline.h"

namespace sim {
namespace {

SplineTrajectory Flight() {
  return SplineTrajectory({{0, {{0, 1, 2}, Exp({0.1, 0, 0})}},
                           {0.7, {{0.5, 1.2, 1.7}, Exp({0.3, 0.6, -0.1})}},
                           {1.4, {{0.6, 1.1, 1.5}, Exp({0.2, 1.2, 0.1})}},
                           {2.0, {{-0.3, 0.8, 1}, Exp({-0.2, 1.9, 0.3})}}});
}

SplineTrajectory AtRest(const glm::dquat& q) { return SplineTrajectory({{0, {{1, 2, 3}, q}}, {1000, {{1, 2, 3}, q}}}); }

ImuParams OffCentre() {
  ImuParams imu;
  imu.T_CI = {{0.05, -0.1, 0.02}, Exp({0.4, -1.2, 0.3})};
  return imu;
}

TEST(Imu, AtRestItFeelsTheFloor) {
  // The camera of docs/conventions.md, level in a world whose up is +y: down is +y of C, and the floor pushes up.
  const SplineTrajectory level = AtRest(Exp({std::acos(-1.0), 0, 0}));
  const ImuSample sample = ImuAt(level, ImuParams{}, 1.0);
  EXPECT_LT(glm::length(sample.f_I - glm::dvec3(0, -9.81, 0)), 1e-12);
  EXPECT_EQ(glm::length(sample.w_I), 0);
}

// f = w^2 r inwards: an IMU on a turntable, 0.2 m from an axis through the camera, 3 rad/s.
TEST(Imu, OnATurntable) {
  class Turntable : public Trajectory {
   public:
    Motion At(double t) const override { return {{{0, 0, 0}, Exp({0, 0, 3 * t})}, {}, {0, 0, 3}}; }
  };
  ImuParams imu;
  imu.gravity_W = glm::dvec3(0);
  imu.T_CI.p_WC = {0.2, 0, 0.7};
  imu.T_CI.q_WC = Exp({0, 0, std::acos(0.0)});  // I's x axis is C's y
  const ImuSample sample = ImuAt(Turntable(), imu, 0.3);
  EXPECT_LT(glm::length(sample.w_I - glm::dvec3(0, 0, 3)), 1e-14);
  EXPECT_LT(glm::length(sample.f_I - glm::dvec3(0, 9 * 0.2, 0)), 1e-14);
}

struct Drift {
  double p, v, q;
};

// Dead reckoning by the trapezoidal rule from the true start to 2 s, against the truth, in the frame I. `made`: of the
// readings; `imu`: of the integration.
Drift Integrate(const Trajectory& trajectory, ImuParams made, const ImuParams& imu, double rate_hz) {
  made.rate_hz = rate_hz;
  const auto samples = ImuReadings(trajectory, made, 1, 0, 2'000'000'000);
  const auto pose_of_I = [&](double t, glm::dvec3& p, glm::dvec3& v, glm::dquat& q) {
    const Motion m = trajectory.At(t);
    p = m.pose.p_WC + m.pose.q_WC * imu.T_CI.p_WC;
    v = m.v_WC + m.pose.q_WC * glm::cross(m.w_WC_C, imu.T_CI.p_WC);
    q = m.pose.q_WC * imu.T_CI.q_WC;
  };
  glm::dvec3 p, v, p_end, v_end;
  glm::dquat q, q_end;
  pose_of_I(0, p, v, q);
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double dt = static_cast<double>(samples[k + 1].stamp_ns - samples[k].stamp_ns) * 1e-9;
    const glm::dvec3 a0 = q * samples[k].f_I + imu.gravity_W;
    q = glm::normalize(q * Exp(0.5 * dt * (samples[k].w_I + samples[k + 1].w_I)));
    const glm::dvec3 a1 = q * samples[k + 1].f_I + imu.gravity_W;
    p += dt * v + dt * dt / 6 * (2.0 * a0 + a1);
    v += dt / 2 * (a0 + a1);
  }
  pose_of_I(static_cast<double>(samples.back().stamp_ns) * 1e-9, p_end, v_end, q_end);
  return {glm::length(p - p_end), glm::length(v - v_end), glm::length(Log(glm::conjugate(q) * q_end))};
}

// Second order of the integration error in the step, as of the trapezoidal rule: the readings are the derivatives of
// the path.
TEST(Imu, IntegratedItGivesThePathToSecondOrder) {
  const SplineTrajectory flight = Flight();
  for (const ImuParams& imu : {ImuParams{}, OffCentre()}) {
    const Drift coarse = Integrate(flight, imu, imu, 200), fine = Integrate(flight, imu, imu, 400);
    EXPECT_NEAR(coarse.p / fine.p, 4, 0.4);
    EXPECT_NEAR(coarse.v / fine.v, 4, 0.4);
    EXPECT_NEAR(coarse.q / fine.q, 4, 0.4);
    EXPECT_LT(fine.p, 1e-4);
    EXPECT_LT(fine.q, 1e-5);
  }
  // Controls: gravity wrong by 1 mm/s^2, an IMU at the camera's centre, a turned one.
  ImuParams heavier = OffCentre(), central = OffCentre(), straight = OffCentre();
  heavier.gravity_W *= 1 + 1e-3 / 9.81;
  central.T_CI.p_WC = {0, 0, 0};
  straight.T_CI.q_WC = Exp({0, 0, 0});
  for (const ImuParams& wrong : {heavier, central, straight}) {
    const Drift drift = Integrate(flight, OffCentre(), wrong, 400);
    EXPECT_GT(drift.p, 1e-3);
    EXPECT_FALSE(drift.p < 1e-4 && drift.q < 1e-5);
  }
}

// Mean readings on a path whose acceleration jumps: exact rotation and velocity. Control: instantaneous readings are
// not exact.
TEST(Imu, MeansOfARoughPathAreExact) {
  SampledMotion motion;
  motion.position_noise = 0.5;
  motion.orientation_noise = 0.5;
  const SampledTrajectory rough(motion, 7, 2.5);
  for (const ImuReading reading : {ImuReading::mean, ImuReading::instant}) {
    ImuParams imu = OffCentre();
    imu.reading = reading;
    glm::dquat turn(1, 0, 0, 0);
    glm::dvec3 gained(0.0);
    const auto velocity = [&](double t) {
      const Motion m = rough.At(t);
      return m.v_WC + m.pose.q_WC * glm::cross(m.w_WC_C, imu.T_CI.p_WC);
    };
    const auto samples = ImuReadings(rough, imu, 1, 0, 1'999'000'000);
    for (std::size_t k = 1; k < samples.size(); ++k) {
      const glm::dquat q_WI = rough.At(static_cast<double>(samples[k].stamp_ns) * 1e-9).pose.q_WC * imu.T_CI.q_WC;
      turn = turn * Exp(samples[k].w_I / imu.rate_hz);
      gained += (q_WI * samples[k].f_I + imu.gravity_W) / imu.rate_hz;
    }
    const double first = 0.5 / imu.rate_hz, last = first + static_cast<double>(samples.size() - 1) / imu.rate_hz;
    const glm::dquat exact =
        glm::conjugate(rough.At(first).pose.q_WC * imu.T_CI.q_WC) * rough.At(last).pose.q_WC * imu.T_CI.q_WC;
    const double turn_error = glm::length(Log(glm::conjugate(turn) * exact)),
                 gain_error = glm::length(gained - (velocity(last) - velocity(first)));
    if (reading == ImuReading::mean) {
      EXPECT_LT(turn_error, 1e-11);
      EXPECT_LT(gain_error, 1e-11);
    } else {
      EXPECT_GT(turn_error, 1e-4);
      EXPECT_GT(gain_error, 1e-2);
    }
  }
}

// Allan variance of non-overlapping means of `m` readings: N^2 / tau for white noise of density N, K^2 tau / 3 for a
// random walk of density K. Its relative standard deviation over M clusters is at most sqrt(1.5 / M) for either (white
// noise: (3 M - 4) / (2 (M - 1)^2) of the variance squared; the walk's differences are less correlated).
double AllanVariance(const std::vector<double>& values, std::size_t m, std::size_t& clusters) {
  std::vector<double> means(values.size() / m, 0.0);
  for (std::size_t i = 0; i < means.size() * m; ++i) means[i / m] += values[i] / static_cast<double>(m);
  double sum = 0;
  for (std::size_t i = 1; i < means.size(); ++i) sum += (means[i] - means[i - 1]) * (means[i] - means[i - 1]);
  clusters = means.size();
  return sum / (2 * static_cast<double>(means.size() - 1));
}

// Allan variance at 12 points, within 5 standard deviations; false-alarm rate below 1 in 10^6 each.
TEST(Imu, NoiseHasItsDensities) {
  const SplineTrajectory rest = AtRest({1, 0, 0, 0});
  ImuParams imu;
  imu.rate_hz = 100;
  imu.gyroscope_noise = 2e-3;
  imu.accelerometer_noise = 3e-2;
  imu.gyroscope_walk = 5e-3;
  imu.accelerometer_walk = 4e-2;
  const auto samples = ImuReadings(rest, imu, 11, 0, 999'999'999'999);
  ASSERT_EQ(samples.size(), 100000u);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool gyroscope : {true, false}) {
      std::vector<double> values, biases;
      for (const ImuSample& s : samples) {
        values.push_back((gyroscope ? s.w_I : s.f_I)[axis]);
        biases.push_back((gyroscope ? s.gyroscope_bias : s.accelerometer_bias)[axis]);
      }
      const double N = gyroscope ? imu.gyroscope_noise : imu.accelerometer_noise,
                   K = gyroscope ? imu.gyroscope_walk : imu.accelerometer_walk;
      for (const std::size_t m : {std::size_t{1}, std::size_t{1000}}) {  // mostly white noise, mostly the walk
        std::size_t clusters = 0;
        const double tau = static_cast<double>(m) / imu.rate_hz, found = AllanVariance(values, m, clusters),
                     expected = N * N / tau + K * K * tau / 3,
                     bound = 5 * std::sqrt(1.5 / static_cast<double>(clusters));
        EXPECT_NEAR(found / expected, 1, bound) << axis << gyroscope << " tau " << tau;
        // Controls: densities twice as large, and a variance of N^2, without the rate.
        EXPECT_GT(std::abs(found / (4 * expected) - 1), bound);
        if (m == 1) {
          EXPECT_GT(std::abs(found / (N * N) - 1), bound);
        }
      }
      EXPECT_EQ(biases[0], 0);
    }
  }
}

TEST(Imu, AReadingDoesNotDependOnTheRange) {
  ImuParams imu = OffCentre();
  imu.gyroscope_noise = imu.accelerometer_noise = imu.gyroscope_walk = imu.accelerometer_walk = 0.1;
  const SplineTrajectory flight = Flight();
  const auto all = ImuReadings(flight, imu, 3, 0, 1'000'000'000),
             part = ImuReadings(flight, imu, 3, 400'000'001, 600'000'000);
  ASSERT_EQ(all.size(), 201u);
  ASSERT_EQ(part.size(), 40u);
  EXPECT_EQ(part[0].stamp_ns, 405'000'000);
  for (std::size_t i = 0; i < part.size(); ++i) {
    EXPECT_EQ(part[i].w_I, all[81 + i].w_I);
    EXPECT_EQ(part[i].f_I, all[81 + i].f_I);
  }
  EXPECT_NE(ImuReadings(flight, imu, 4, 0, 0)[0].f_I, all[0].f_I);
}

}  // namespace
}  // namespace sim
