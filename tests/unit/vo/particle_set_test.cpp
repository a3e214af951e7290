// Particle set and landmark table: weights, replacement, resampling, and the indices of landmarks and anchors.
#include "vo/filter/particle_set.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <vector>

#include "vo/filter/landmark_table.h"

namespace {

using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Particle i stands at x = i.
vo::ParticleSet Set(const std::vector<double>& log_weights) {
  vo::ParticleSet set(static_cast<int>(log_weights.size()));
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i].pose.p_WC.x() = static_cast<double>(i);
    set[i].log_weight = log_weights[i];
  }
  return set;
}

std::vector<double> Places(const vo::ParticleSet& set) {
  std::vector<double> places;
  for (const vo::Particle& particle : set.particles()) places.push_back(particle.pose.p_WC.x());
  return places;
}

TEST(ParticleSet, NormalisesLogWeights) {
  vo::ParticleSet set = Set({-1000, -1000 + std::log(3), -5000});
  EXPECT_THAT(set.Normalise().particles, IsEmpty());
  EXPECT_THAT(set.weights(), ElementsAre(DoubleNear(0.25, 1e-12), DoubleNear(0.75, 1e-12), 0.0));
  EXPECT_EQ(set[1].log_weight, 0);
  EXPECT_EQ(set.Heaviest(), 1u);
  EXPECT_NEAR(set.EffectiveSize(), 1 / (0.25 * 0.25 + 0.75 * 0.75), 1e-12);
}

TEST(ParticleSet, ReplacesAParticleWithoutAWeight) {
  vo::ParticleSet set = Set({0, std::log(2), kNan});
  const vo::ParticleSet::Replacement replaced = set.Normalise();
  EXPECT_THAT(replaced.particles, ElementsAre(2));
  EXPECT_EQ(replaced.by, 1);
  EXPECT_THAT(Places(set), ElementsAre(0, 1, 1));
  EXPECT_THAT(set.weights(),
              ElementsAre(DoubleNear(1. / 3, 1e-12), DoubleNear(1. / 3, 1e-12), DoubleNear(1. / 3, 1e-12)));
  EXPECT_DOUBLE_EQ(set[1].log_weight, -std::log(2));
  EXPECT_EQ(set[2].log_weight, set[1].log_weight);
}

TEST(ParticleSet, BeginsAgainWhereNoWeightIsFinite) {
  vo::ParticleSet set = Set({kNan, -INFINITY, kNan, INFINITY});
  const vo::ParticleSet::Replacement replaced = set.Normalise();
  EXPECT_EQ(replaced.by, -1);
  EXPECT_THAT(replaced.particles, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(Places(set), ElementsAre(0, 1, 2, 3));
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_EQ(set.weights()[i], 0.25);
    EXPECT_EQ(set[i].log_weight, 0);
  }
}

TEST(ParticleSet, UniformWeightsRejectByTheBayesFactor) {
  vo::ParticleSet set = Set({0, 0, 0, 0});
  set.NormaliseUniform({-100, -149, -151, -100}, 50);
  EXPECT_THAT(set.weights(), ElementsAre(DoubleEq(1. / 3), DoubleEq(1. / 3), 0.0, DoubleEq(1. / 3)));
  EXPECT_TRUE(set.AnyRejected());
  set.NormaliseUniform({-100, -149, -149, -100}, 50);
  EXPECT_FALSE(set.AnyRejected());
  set.NormaliseUniform({-1000, kNan, -INFINITY, -1003}, 50);
  EXPECT_THAT(set.weights(), ElementsAre(0.5, 0.0, 0.0, 0.5));
  set.NormaliseUniform({kNan, -INFINITY, kNan, kNan}, 50);
  EXPECT_THAT(set.weights(), ElementsAre(0.25, 0.25, 0.25, 0.25));
}

// A log weight is lost and the evidence of the present window is finite.
TEST(ParticleSet, UniformWeightsSumToOneWhereALogWeightIsLost) {
  vo::ParticleSet set = Set({0, kNan, 0});
  const vo::ParticleSet::Replacement replaced = set.NormaliseUniform({-1, -2, -100}, 50);
  EXPECT_THAT(replaced.particles, ElementsAre(1));
  EXPECT_EQ(replaced.by, 0);
  EXPECT_THAT(set.weights(), ElementsAre(0.5, 0.5, 0.0));
}

// Systematic resampling at u = 0.5: points at (k + 0.5) / 4 of the cumulated weights.
TEST(ParticleSet, Resamples) {
  vo::ParticleSet set = Set({std::log(0.1), std::log(0.55), std::log(0.05), std::log(0.3)});
  set.Normalise();
  set.Resample(0.5);
  EXPECT_THAT(Places(set), ElementsAre(1, 1, 1, 3));
  EXPECT_THAT(set.weights(), ElementsAre(0.25, 0.25, 0.25, 0.25));
  for (const vo::Particle& particle : set.particles()) EXPECT_EQ(particle.log_weight, 0);
}

TEST(LandmarkTable, UsesAnAnchorAgainOnceItsLandmarksAreGone) {
  vo::LandmarkTable table;
  EXPECT_EQ(table.Add(2), 0);
  EXPECT_EQ(table.Add(1), 1);
  EXPECT_EQ(table.Add(2), 2);
  EXPECT_THAT(table.Keep({true, false, false, true, true}), ElementsAre(0, -1, -1, 1, 2));
  EXPECT_THAT(table.anchors(), ElementsAre(0, 2, 2));
  EXPECT_EQ(table.anchor_count(), 3);
  EXPECT_EQ(table.Add(1), 1);
  EXPECT_EQ(table.Add(1), 3);
  EXPECT_EQ(table.size(), 5);
}

}  // namespace
