#include "sim/sequence/landmarks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/unit/sim/small_world.h"

namespace sim {
namespace {

TEST(Landmarks, LieOnTheWallAndAreSpread) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1), again(LoadScenario(world.scenario()), 2);
  const auto landmarks = SpreadLandmarks(simulator, 40), same = SpreadLandmarks(again, 40);
  ASSERT_EQ(landmarks.size(), 40u);
  double nearest = 1e9;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    EXPECT_EQ(landmarks[i].X_W, same[i].X_W);
    EXPECT_NEAR(landmarks[i].X_W.z, -2, 1e-12);
    for (std::size_t k = 0; k < i; ++k) nearest = std::min(nearest, glm::length(landmarks[i].X_W - landmarks[k].X_W));
  }
  // About 2.5 m x 1.9 m are in view: 0.35 m between neighbours on a square grid of 40, some within 5 cm at random
  // places.
  EXPECT_GT(nearest, 0.2);
}

TEST(Landmarks, ViewsAreProjections) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const auto landmarks = SpreadLandmarks(simulator, 40);
  for (const std::int64_t k : {0, 8}) {
    const Truth truth = simulator.TruthAt(k);
    const auto views = ViewsOf(simulator, landmarks, k);
    EXPECT_GT(views.size(), 20u);
    for (const LandmarkView& view : views) {
      const glm::dvec3 X_C = glm::conjugate(truth.q_WC) * (landmarks[view.id].X_W - truth.p_WC);
      EXPECT_NEAR(view.pixel.x, 52 * X_C.x / X_C.z + 31.5, 1e-11);
      EXPECT_NEAR(view.pixel.y, 52 * X_C.y / X_C.z + 23.5, 1e-11);
      EXPECT_TRUE(view.visible) << "nothing is before the wall";
    }
  }
}

}  // namespace
}  // namespace sim
