#include "sim/motion/carrier_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "sim/motion/path.h"
#include "sim/motion/roaming.h"
#include "tests/unit/sim/motion_check.h"

namespace sim {
namespace {

RoamingMotion Free(Carrier model) {
  RoamingMotion motion;
  motion.carrier.model = model;
  motion.start.emplace();
  return motion;
}

// Error of the fourth-order stencil with h = 1 ms. Position: a cubic on each segment of the spline, so rounding alone,
// some 1e-16 m / 1 ms. Orientation: h^4/30 times a fifth derivative below 1e6 rad/s^5, 3e-8.
TEST(CarrierMotion, VelocitiesAndAccelerationsAreTheDerivatives) {
  constexpr double kStep = 1e-3;
  for (const Carrier model : {Carrier::handheld, Carrier::drone}) {
    const auto path = MakeRoaming(Free(model), 3, 5, nullptr);
    for (int k = 1; k < 480; k += 7) {
      const RateErrors errors = RateErrorsAt(*path, kCarrierStep_s * (k + 0.5), kStep);
      EXPECT_LT(errors.v, 1e-11) << k;
      EXPECT_LT(errors.a, 1e-9) << k;
      EXPECT_LT(errors.w, 1e-7) << k;
      EXPECT_LT(errors.alpha, 1e-4) << k;
    }
  }
}

TEST(CarrierMotion, TheSameSeedGivesTheSameBytes) {
  const auto bytes = [](const RoamingMotion& motion, std::uint64_t seed) {
    std::vector<Motion> motions;
    const auto path = MakeRoaming(motion, seed, 3, nullptr);
    for (double t = 0; t < 3; t += 0.037) motions.push_back(path->At(t));
    return motions;
  };
  const auto same = [](const std::vector<Motion>& a, const std::vector<Motion>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(Motion)) == 0;
  };
  RoamingMotion motion = Free(Carrier::handheld);
  const auto first = bytes(motion, 5);
  EXPECT_TRUE(same(first, bytes(motion, 5)));
  EXPECT_FALSE(same(first, bytes(motion, 6)));
  motion.carrier.seed = 5;
  EXPECT_TRUE(same(first, bytes(motion, 6))) << "the path's own seed comes before the scenario's";
}

CarrierMotionParams With(double vehemence, double tremor) {
  CarrierMotionParams params;
  params.vehemence = vehemence;
  params.tremor = tremor;
  return params;
}

// Mean of |a|^2 over independent seeds minus that of the table, in standard errors. False-alarm rate of 4.5: 1 in
// 150 000.
double DeviationOfTremor(double tremor, double stated) {
  CarrierMotionParams params = With(0, tremor);
  params.speed = params.turn_rate = 100;
  const CarrierMotion carrier(params, 0.69);
  double expected = 0, sum = 0, squares = 0;
  for (std::size_t j = 4; j < kCarrierComponents; ++j)
    expected += std::pow(stated * carrier.table().linear_tremor[j], 2);
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto x = carrier.Draw(static_cast<std::uint64_t>(seed), 3);
    const glm::dvec3 a = (x[0].move - 2.0 * x[1].move + x[2].move) / (kCarrierStep_s * kCarrierStep_s);
    sum += glm::dot(a, a) / kSeeds;
    squares += std::pow(glm::dot(a, a), 2) / kSeeds;
  }
  return (sum - expected) / std::sqrt((squares - sum * sum) / kSeeds);
}

TEST(CarrierMotion, AccelerationsAreTheTables) {
  EXPECT_LT(std::abs(DeviationOfTremor(1, 1)), 4.5);
  EXPECT_GT(std::abs(DeviationOfTremor(1.5, 1)), 4.5);
}

TEST(CarrierMotion, AShakeIsAddedToThePath) {
  PathMotion dolly;
  dolly.move = {2, 0, 0};
  dolly.along = {Swing::Kind::there_and_back, 1, 8};
  const PathTrajectory path(dolly);
  const auto rms = [&](const CarrierMotionParams& shake) {
    const auto shaken = Shaken(path, shake, 1, 8);
    double sum = 0;
    for (int k = 0; k < 160; ++k) {
      const glm::dvec3 d = shaken->At(0.05 * k).pose.p_WC - path.At(0.05 * k).pose.p_WC;
      sum += glm::dot(d, d) / 160;
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(rms(With(0, 0)), 1e-6) << "what the spline leaves of a swing of 8 s";
  EXPECT_GT(rms({}), 0.002);
  EXPECT_LT(rms({}), 0.05);
  EXPECT_NEAR(rms(With(2, 2)) / rms({}), 2, 1e-3) << "the same numbers, twice as large";
}

// Velocity along the vehicle's own axis, level: exact at the keys, and to the spline's curvature between them.
TEST(Vehicle, DoesNotSlip) {
  RoamingMotion motion;
  motion.carrier.model = Carrier::vehicle;
  motion.start = {{1, 1.5, 2}, {0, 1, 0, 0}};  // level, towards -z
  const auto path = MakeRoaming(motion, 4, 20, nullptr);
  double fastest = 0;
  for (int k = 10; k < 1990; ++k) {
    const Motion at = path->At(0.01 * k);
    const glm::dvec3 forward = at.pose.q_WC * glm::dvec3(0, 0, 1);
    EXPECT_NEAR(at.pose.p_WC.y, 1.5, 1e-12);
    EXPECT_LT(glm::length(at.v_WC - glm::dot(at.v_WC, forward) * forward), 0.02) << k;
    EXPECT_GE(glm::dot(at.v_WC, forward), -1e-3);
    EXPECT_LT(std::abs(at.w_WC_C.y), glm::length(at.v_WC) / motion.turning_radius + 0.01);
    fastest = std::max(fastest, glm::length(at.v_WC));
  }
  EXPECT_GT(fastest, 2);
}

}  // namespace
}  // namespace sim
