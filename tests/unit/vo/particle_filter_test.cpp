// What the particle filter does to its particles, whatever the images say.
#include "vo/filter/particle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_field.h"
#include "tests/unit/vo/wall.h"
#include "vo/base/random.h"
#include "vo/filter/particle_set.h"
#include "vo/geometry/so3.h"

namespace {

constexpr int kLandmarks = 30;
constexpr std::uint64_t kSeed = 4;

vo::ParticleFilter MakeFilter(const vo::FilterParams& params) {
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::ParticleFilter filter(vo::MotionParams{}, params, vo::LandmarkParams{}, prior, kSeed);
  filter.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  return filter;
}

void Step(vo::ParticleFilter& filter, int frame) {
  filter.Predict(1.0 / 30);
  filter.Update(vo_test::WallMatches(kLandmarks, frame));
}

TEST(ParticleFilter, ChildrenAreTheirAncestors) {
  for (const int particles : {1, 2, 9, 64}) {
    vo::FilterParams params;
    params.particles = particles;
    params.sampled = vo::Sampled::pose_and_velocity;  // so that their weights differ from the first frame on
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
    for (int frame = 2; frame < 6; ++frame) Step(filter, frame);  // in the memory of others
    for (const vo::Particle& particle : filter.particles()) EXPECT_EQ(particle.landmarks.size(), kLandmarks);
  }
}

// What the filter computes once for all of them.
TEST(ParticleFilter, VelocityCovarianceIsAlikeInAllParticles) {
  for (const vo::Sampled sampled : {vo::Sampled::pose, vo::Sampled::pose_and_velocity}) {
    for (const int lag : {0, 2}) {
      vo::FilterParams params;
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

constexpr int kWorlds = 200, kStartFrames = 10;

// A camera of hardly known velocity that circles what it looks at, for kStartFrames: where it is believed to have gone, and where it went.
struct Start {
  Eigen::Vector3d believed, truth;
};

Start PlayStart(unsigned world, const vo::FilterParams& params, double noise_px, double depth_spread) {
  const double noise = noise_px / 525;
  vo_test::Draws draws(world);
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::ParticleFilter filter({.position_noise = 0.6, .orientation_noise = 0.4}, params, vo::LandmarkParams{}, prior,
                            world);
  const vo_test::LandmarkField field({40, 0.5, 0.4, depth_spread, noise}, draws);
  filter.AddLandmarks(field.first_views);
  const double angle = 6.283 * draws.Uniform();
  const Eigen::Vector3d velocity(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0);
  vo::Pose camera;
  for (int frame = 1; frame <= kStartFrames; ++frame) {
    const double t = frame / 30.0;
    camera = {velocity * t, vo::Exp(Eigen::Vector3d(0.25 * velocity.y(), -0.25 * velocity.x(), 0) * t)};
    filter.Predict(1.0 / 30);
    filter.Update(field.SeenFrom(camera));
  }
  return {filter.belief().pose.p_WC, camera.p_WC};
}

// In the first frames, seen from afar, a scene and its mirror image (near and far exchanged, the camera going the other way) look alike. Counted
// are the worlds in which it is believed to have gone the other way.
int StartsMirrored(const vo::FilterParams& params) {
  int mirrored = 0;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    const Start start = PlayStart(world, params, 0.2, 0.2);
    mirrored += start.believed.dot(start.truth) < 0;
  }
  return mirrored;
}

// The lag's window and the start's look for the better solution alike; who samples from the first frame on has no way back.
TEST(ParticleFilter, DoesNotStartMirrored) {
  vo::FilterParams params;
  params.particles = 1;
  params.start_window = kStartFrames;
  const int window = StartsMirrored(params);
  params.start_window = 0;
  const int at_once = StartsMirrored(params);
  params.lag = kStartFrames;
  const int lag = StartsMirrored(params);
  std::printf("mirrored, of %d: start window %d, lag %d, neither %d\n", kWorlds, window, lag, at_once);
  EXPECT_LE(window, 10);
  EXPECT_EQ(window, lag);
  EXPECT_GT(at_once, 2 * window);
}

// A wall seen face on: what explains it nearly as well is a deep scene with little parallax, whose depths stay unknown, and evidence pays for
// that (with it 129 of these 200 went wrong; with 0.3 px of noise, and depths within 3 % of each other, 186, and 6 as it is).
TEST(ParticleFilter, TakesAWallForAWall) {
  vo::FilterParams params;
  params.particles = 1;
  params.start_window = kStartFrames;
  int wrong = 0;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    const Start start = PlayStart(world, params, 0.1, 0);
    wrong += start.believed.normalized().dot(start.truth.normalized()) < 0.7;
  }
  std::printf("more than 45 degrees off: %d of %d\n", wrong, kWorlds);
  EXPECT_LE(wrong, 10);
}

}  // namespace
