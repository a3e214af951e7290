// Scale during the start: each solution of the window has its own scale, determined by the priors of the depths alone.
// FilterAnswer::scale_change brings all estimates to one scale.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_field.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

namespace {

constexpr int kFrames = 30, kWorlds = 10;
constexpr double kSigma = 0.25 / 525;

// Change of the log scale from a frame of the start to its last one: of the filter's path and of the answers.
struct Change {
  double filter = 0, answers = 0;
};

// A camera at `speed` past landmarks with inverse depths about 0.25 1/m, evenly spread over twice `spread`.
Change Fly(unsigned world, double speed, double spread, int from) {
  vo_test::Draws draws(world);
  vo::ParticleFilter filter = vo_test::StartingFilter(world);
  const vo_test::LandmarkField field({60, 0.8, 0.6, 2 * spread, kSigma}, draws);
  filter.AddLandmarks(field.first_views);
  Change change;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double t = frame / 30.0;
    const vo::Pose camera{{speed * t, 0.1 * speed * std::sin(2 * t), 0},
                          vo::Exp({0, -0.05 * t, 0.05 * std::sin(3 * t)})};
    filter.Predict(1.0 / 30);
    filter.Update(field.SeenFrom(camera));
    const double ratio = std::log(filter.belief().pose.p_WC.norm() / camera.p_WC.norm());
    if (frame == from) change = {-ratio, -ratio};
    if (frame > from) change.answers -= std::log(filter.answer().scale_change);
    if (frame == kFrames) {
      change.filter += ratio;
      change.answers += ratio;
    }
  }
  return change;
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// Median over the worlds, of the absolute value.
Change Fly(double speed, double spread, int from) {
  std::vector<double> filter, answers;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    const Change change = Fly(world, speed, spread, from);
    filter.push_back(std::abs(change.filter));
    answers.push_back(std::abs(change.answers));
  }
  std::printf(
      "%.1f m/s past depths spread by %.1f, from frame %d on: the filter's scale changes by %.3f, the answers' by "
      "%.3f\n",
      speed, spread, from, Median(filter), Median(answers));
  return {Median(filter), Median(answers)};
}

// Spread depths: near depths gain weight in the scale as the depths become observable. Measured 0.029 and 0.184.
TEST(StartScale, SpreadDepths) {
  for (const double speed : {1.0, 0.3}) {
    const Change change = Fly(speed, 0.2, 6);
    EXPECT_GT(change.filter, 0.02);
    EXPECT_LT(change.answers, 0.4 * change.filter);
  }
}

// Wall: the scale is not held where noise alone determines it, since the filter's later estimates are better. Measured
// 0.49 and 0.31.
TEST(StartScale, PlaneWithLittleInformation) {
  const Change change = Fly(0.3, 0, 3);
  EXPECT_GT(change.filter, 0.2);
  EXPECT_GT(change.answers, 0.5 * change.filter);
}

// scale_change differs from 1 in more than half of the start's frames and is 1 after the start.
TEST(StartScale, ConstantAfterTheStart) {
  vo_test::Draws draws(1);
  vo::ParticleFilter filter({}, vo::FilterParams{}, vo::LandmarkParams{}, vo::FilterPrior{}, 1);
  const vo_test::LandmarkField field({60, 0.8, 0.6, 0.4, kSigma}, draws);
  filter.AddLandmarks(field.first_views);
  int rescaled = 0;
  for (int frame = 1; frame <= kFrames + 10; ++frame) {
    filter.Predict(1.0 / 30);
    filter.Update(field.SeenFrom({{frame / 30.0, 0, 0}, Eigen::Quaterniond::Identity()}));
    if (frame > kFrames + 1) {
      EXPECT_EQ(filter.answer().scale_change, 1) << frame;
    } else {
      rescaled += filter.answer().scale_change != 1;
    }
  }
  EXPECT_GT(rescaled, kFrames / 2);
}

}  // namespace
