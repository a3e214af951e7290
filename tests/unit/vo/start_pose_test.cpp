// Start at an unknown pose: each particle begins at its own, and during the start window all have the first one's
// solution relative to it.
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_field.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

namespace {

vo::ParticleFilter FilterFrom(const vo::PoseGaussian& start, int particles) {
  vo::FilterParams params = vo_test::SampledAtOnce();
  params.particles = particles;
  vo::FilterPrior prior;
  prior.pose = start;
  prior.velocity_covariance = 0.25 * vo::Matrix6::Identity();
  return {vo::MotionParams{}, params, vo::LandmarkParams{}, prior, 3};
}

// Particles against filters whose prior is each one's start pose. With an isotropic velocity of mean zero the estimate
// relative to the start does not depend on its pose; only rounding differs.
TEST(StartPose, EveryParticleIsAFilterFromThere) {
  constexpr double kSigma = 1.0 / 525;
  vo_test::Draws draws(2);
  const vo_test::LandmarkField field({60, 0.8, 0.6, 0.2, kSigma}, draws);
  vo::PoseGaussian start;
  start.covariance = 0.25 * vo::Matrix6::Identity();
  std::vector<vo::ParticleFilter> filters;
  filters.push_back(FilterFrom(start, 8));
  for (int i = 0; i < 8; ++i)
    filters.push_back(FilterFrom({filters[0].particles()[static_cast<std::size_t>(i)].pose, vo::Matrix6::Zero()}, 1));
  for (vo::ParticleFilter& filter : filters) filter.AddLandmarks(field.first_views);
  for (int frame = 1; frame <= 10; ++frame) {
    const std::vector<vo::Match> matches = field.SeenFrom({{0, 0, 0.02 * frame}, vo::Exp({0, 0.005 * frame, 0})});
    for (vo::ParticleFilter& filter : filters) {
      filter.Predict(1.0 / 30);
      filter.Update(matches);
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const vo::BeliefComponent &one = filters[0].mixture()[i], &alone = filters[i + 1].mixture()[0];
      EXPECT_LT(vo::Minus(one.pose, alone.pose).norm(), 1e-6);
      EXPECT_LT((one.velocity - alone.velocity).norm(), 1e-6);
      // In units of the standard deviations.
      const Eigen::Matrix<double, 12, 1> scale = alone.covariance.diagonal().cwiseSqrt().cwiseInverse();
      EXPECT_LT((scale.asDiagonal() * (one.covariance - alone.covariance) * scale.asDiagonal()).norm(), 1e-6)
          << "frame " << frame << ", particle " << i;
    }
  }
}

}  // namespace
