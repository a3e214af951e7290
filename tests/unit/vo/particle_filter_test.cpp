// Resampling of the particle filter, and the covariance shared by its particles.
#include "vo/filter/particle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/wall.h"
#include "vo/base/random.h"
#include "vo/filter/particle_set.h"
#include "vo/geometry/so3.h"

namespace {

constexpr int kLandmarks = 30;
constexpr std::uint64_t kSeed = 4;

vo::ParticleFilter MakeFilter(const vo::FilterParams& params, const vo::MotionParams& motion = {}) {
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::ParticleFilter filter(motion, params, vo::LandmarkParams{}, prior, kSeed);
  filter.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  return filter;
}

void Step(vo::ParticleFilter& filter, int frame) {
  filter.Predict(1.0 / 30);
  filter.Update(vo_test::WallMatches(kLandmarks, frame));
}

TEST(ParticleFilter, ChildrenAreTheirAncestors) {
  for (const int particles : {1, 2, 9, 64}) {
    vo::FilterParams params = vo_test::SampledAtOnce();
    params.particles = particles;
    params.sampled = vo::Sampled::pose_and_velocity;  // weights differ from the first frame on
    params.resample_below = 0;
    vo::ParticleFilter parents = MakeFilter(params);
    params.resample_below = 1.5;  // always
    vo::ParticleFilter filter = MakeFilter(params);
    Step(parents, 1);
    Step(filter, 1);
    std::vector<int> ancestors;
    vo::SystematicAncestors(parents.weights(), vo::Uniform({kSeed, vo::Stream::resampling, 1, 0}, 0), ancestors);
    EXPECT_TRUE(std::adjacent_find(ancestors.begin(), ancestors.end()) != ancestors.end() || particles < 9);
    for (int i = 0; i < particles; ++i) {
      const vo::Particle &child = filter.particles()[i], &parent = parents.particles()[ancestors[i]];
      EXPECT_EQ(child.log_weight, 0);
      EXPECT_EQ(child.pose.p_WC, parent.pose.p_WC);
      EXPECT_EQ(child.velocity.mean, parent.velocity.mean);
      ASSERT_EQ(child.landmarks.size(), parent.landmarks.size());
      for (std::size_t n = 0; n < kLandmarks; ++n) EXPECT_EQ(child.landmarks[n].mean, parent.landmarks[n].mean);
    }
    for (int frame = 2; frame < 6; ++frame) Step(filter, frame);  // in reused memory
    for (const vo::Particle& particle : filter.particles()) EXPECT_EQ(particle.landmarks.size(), kLandmarks);
  }
}

// Innovations are measured by the covariance of the velocity that the mixture has, also where each particle samples it.
TEST(ParticleFilter, ReferencePredictionContainsTheSampledVelocity) {
  const auto first_prediction = [](vo::Sampled sampled, bool adaptive) {
    vo::FilterParams params = vo_test::SampledAtOnce();
    params.sampled = sampled;
    vo::MotionParams motion;
    motion.adaptive = adaptive;
    vo::ParticleFilter filter = MakeFilter(params, motion);
    filter.Predict(1.0 / 30);
    return filter.Reference().prediction;
  };
  const vo::PoseGaussian integrated = first_prediction(vo::Sampled::pose, true);
  const vo::PoseGaussian sampled = first_prediction(vo::Sampled::pose_and_velocity, true);
  EXPECT_LT((sampled.covariance - integrated.covariance).norm(), 1e-12 * integrated.covariance.norm());
  EXPECT_LT(vo::Minus(sampled.mean, integrated.mean).norm(), 1e-12);
  const vo::PoseGaussian paper = first_prediction(vo::Sampled::pose_and_velocity, false);
  EXPECT_LT(paper.covariance.trace(), 0.9 * integrated.covariance.trace()) << "of the particle alone";
  EXPECT_GT(vo::Minus(paper.mean, integrated.mean).norm(), 1e-3);
}

// Velocity covariance, which the filter computes once for all particles.
TEST(ParticleFilter, VelocityCovarianceIsAlikeInAllParticles) {
  for (const vo::Sampled sampled : {vo::Sampled::pose, vo::Sampled::pose_and_velocity}) {
    for (const int lag : {0, 2}) {
      vo::FilterParams params = vo_test::SampledAtOnce();
      params.sampled = sampled;
      params.lag = lag;
      params.start_window = 4;
      vo::ParticleFilter filter = MakeFilter(params);
      for (int frame = 1; frame < 8; ++frame) Step(filter, frame);
      for (const vo::Particle& particle : filter.particles())
        EXPECT_EQ(particle.velocity.covariance, filter.particles()[0].velocity.covariance);
    }
  }
}

}  // namespace
