// Random streams of simulator and odometry: one generator, often with the same seed, 1, but no number in common.
#include "sim/random/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "vo/base/random.h"

namespace {

TEST(RandomContract, TheOdometryHasStreamsOfItsOwn) {
  using Of = sim::Stream;
  const std::vector<Of> simulator = {Of::position_noise, Of::orientation_noise, Of::ray_jitter,    Of::pixel_noise,
                                     Of::light_path,     Of::fixed_pattern,     Of::depth_noise,   Of::start_velocity,
                                     Of::point_place,    Of::point_noise,       Of::point_outlier, Of::point_loss,
                                     Of::point_scale,    Of::imu_noise,         Of::imu_walk,      Of::landmark_place,
                                     Of::object_motion};
  std::vector<double> theirs;
  for (const Of stream : simulator) {
    const sim::Words words = sim::RandomWords(1, stream, 2, 3, 4);
    theirs.push_back(sim::Uniform(words[0], words[1]));
  }
  for (const vo::Stream stream : {vo::Stream::prior_pose, vo::Stream::prior_velocity, vo::Stream::pose,
                                  vo::Stream::velocity, vo::Stream::resampling}) {
    // The fields of the key are in another order here: equal streams would give the same block of the generator.
    const double ours = vo::Uniform({.seed = 1, .stream = stream, .frame = 4, .particle = 3}, 2);
    for (const double other : theirs) EXPECT_GT(std::abs(ours - other), 1e-9);
  }
}

}  // namespace
