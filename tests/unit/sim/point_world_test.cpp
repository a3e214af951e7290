#include "sim/points/point_world.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/motion/so3.h"
#include "tests/unit/sim/points.h"

namespace sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Camera along -z, upright in a world with y up: x right, y down = -y, z = -z. At (1, 2, 3), and a second later half a
// metre further to the right.
Scenario TwoFrames() {
  Scenario scenario = PointScenario();
  scenario.time = {1, 2};
  ScriptedMotion motion;
  const glm::dquat half_turn_about_x(0, 1, 0, 0);
  motion.keys = {{0, {{1, 2, 3}, half_turn_about_x}}, {1, {{1.5, 2, 3}, half_turn_about_x}}};
  scenario.motion = motion;
  return scenario;
}

TEST(PointWorld, ProjectsAsWorkedByHand) {
  const PointWorld world(TwoFrames());
  // X_C = (0.5, 0.25, 2): u = 525 / 4 + 319.5, v = 525 / 8 + 239.5; from half a metre further right X_C = (0, 0.25, 2).
  const PointLandmark point{0, {1.5, 1.75, 1, 1}, 0};
  EXPECT_NEAR(world.Project(point, 0)->x, 450.75, 1e-10);
  EXPECT_NEAR(world.Project(point, 0)->y, 305.125, 1e-10);
  EXPECT_NEAR(world.Project(point, 1)->x, 319.5, 1e-10);
  // At infinity, X_C = (0.1, 0.2, 1) in both frames.
  const PointLandmark star{0, {0.1, -0.2, -1, 0}, 0};
  for (const std::int64_t frame : {0, 1}) {
    EXPECT_NEAR(world.Project(star, frame)->x, 372, 1e-10);
    EXPECT_NEAR(world.Project(star, frame)->y, 344.5, 1e-10);
  }
  // The same ray from the first camera with inverse depths of 0.1 and -0.1: to the left by 0.05 f, and to the right.
  const auto anchored = [](double rho) {
    return PointLandmark{0, {rho * 1 + 0.1, rho * 2 - 0.2, rho * 3 - 1, rho}, 0};
  };
  EXPECT_NEAR(world.Project(anchored(0.1), 0)->x, 372, 1e-10);
  EXPECT_NEAR(world.Project(anchored(-0.1), 0)->x, 372, 1e-10);
  EXPECT_NEAR(world.Project(anchored(0.1), 1)->x, 345.75, 1e-10);
  EXPECT_NEAR(world.Project(anchored(-0.1), 1)->x, 398.25, 1e-10);
  // Behind the camera, and beside the image.
  EXPECT_FALSE(world.Project({0, {1.5, 1.75, 5, 1}, 0}, 0));
  EXPECT_FALSE(world.Project({0, {3.5, 1.75, 1, 1}, 0}, 0));
}

TEST(PointWorld, ProjectsThroughTheLensAsWorkedByHand) {
  Scenario scenario = TwoFrames();
  scenario.camera = {640, 480, 500, 400, 320, 240, 0.1, -0.2, 0.01, -0.02, 0.05};  // docs/conventions.md
  const PointWorld world(scenario);
  const PointLandmark point{0, {1.5, 2.25, 2, 1}, 0};  // X_C = (0.5, -0.25, 1)
  EXPECT_NEAR(world.Project(point, 0)->x, 563.9361572265625, 1e-10);
  EXPECT_NEAR(world.Project(point, 0)->y, 142.425537109375, 1e-10);
}

TEST(PointWorld, TheSameSeedGivesTheSameNumbers) {
  const auto numbers = [](Scenario scenario, double seconds) {
    scenario.time.duration_s = seconds;
    scenario.points->measurement.outlier_probability = scenario.points->measurement.drop_probability = 0.1;
    PointWorld world(scenario);
    std::vector<std::array<double, 4>> all;
    for (const PointFrame& frame : Play(world)) {
      if (frame.index >= 15) break;
      for (const PointObservation& o : frame.observations)
        all.push_back({static_cast<double>(frame.stamp_ns), static_cast<double>(o.id), o.x_px, o.y_px});
    }
    return all;
  };
  for (const Landmarks landmarks : {Landmarks::prior, Landmarks::room, Landmarks::plane, Landmarks::cloud}) {
    const auto first = numbers(MovingPointScenario(landmarks, 7), 0.5);
    EXPECT_GT(first.size(), 500u);
    EXPECT_EQ(first, numbers(MovingPointScenario(landmarks, 7), 0.5));
    EXPECT_EQ(first, numbers(MovingPointScenario(landmarks, 7), 3)) << "longer, it begins the same";
    EXPECT_NE(first, numbers(MovingPointScenario(landmarks, 8), 0.5));
    EXPECT_NE(first, numbers(MovingPointScenario(landmarks, 7 + (1ull << 32)), 0.5)) << "all 64 bits count";
  }
}

TEST(PointWorld, AFrameHasCountViewsInOrderAndItsTruth) {
  PointWorld world(MovingPointScenario());
  std::int64_t index = 0;
  for (const PointFrame& frame : Play(world)) {
    EXPECT_EQ(frame.index, index);
    EXPECT_EQ(frame.stamp_ns, world.StampNs(index));
    EXPECT_EQ(frame.truth.p_WC, world.TruthAt(index).p_WC);
    EXPECT_GE(frame.observations.size(), 100u) << "one that comes back may be one more";
    for (std::size_t i = 1; i < frame.observations.size(); ++i)
      EXPECT_LT(frame.observations[i - 1].id, frame.observations[i].id);
    ++index;
  }
  EXPECT_EQ(index, 30);
  EXPECT_GT(world.landmarks().size(), 110u) << "some have left the image";
  for (std::size_t i = 0; i < world.landmarks().size(); ++i)
    EXPECT_EQ(world.landmarks()[i].id, static_cast<std::int64_t>(i));
}

// Squared noise of all views over sigma^2: chi-squared with 2 degrees of freedom each. False-alarm rate at five
// standard deviations: 1 in 1.7 million.
TEST(PointWorld, NoiseIsGaussianWithTheSigmaAskedFor) {
  Scenario scenario = MovingPointScenario();
  scenario.time.duration_s = 10;
  scenario.points->measurement.noise_px = 0.7;
  PointWorld world(scenario);
  const std::vector<PointFrame> frames = Play(world);
  double squares = 0, across = 0, in_time = 0, fourth = 0, n = 0, pairs = 0;
  std::map<std::int64_t, glm::dvec2> last;
  for (const PointFrame& frame : frames) {
    for (const PointObservation& o : frame.observations) {
      const auto at = world.Project(world.landmarks()[static_cast<std::size_t>(o.id)], frame.index);
      ASSERT_TRUE(at);
      const glm::dvec2 e = (glm::dvec2(o.x_px, o.y_px) - *at) / 0.7;
      squares += e.x * e.x + e.y * e.y;
      fourth += std::pow(e.x, 4) + std::pow(e.y, 4);
      across += e.x * e.y;
      n += 1;
      if (const auto before = last.find(o.id); before != last.end()) {
        in_time += e.x * before->second.x;
        pairs += 1;
      }
      last[o.id] = e;
    }
  }
  ASSERT_GE(n, 30000);
  const auto score = [&](double sigma_ratio) {
    return (squares / sigma_ratio / sigma_ratio - 2 * n) / std::sqrt(4 * n);
  };
  EXPECT_LT(std::abs(score(1)), 5);
  EXPECT_GT(std::abs(score(1.03)), 5) << "three per cent more would be noticed";
  EXPECT_LT(std::abs(fourth / (2 * n) - 3), 5 * std::sqrt(96 / (2 * n))) << "kurtosis of a Gaussian";
  EXPECT_LT(std::abs(across) / std::sqrt(n), 5);
  EXPECT_LT(std::abs(in_time) / std::sqrt(pairs), 5);
}

// Prior of 20 000 landmarks of one frame. Bounds of five standard deviations each; the chi-squared of 48 cells is below
// 105 with probability 1 - 4e-6.
TEST(PointWorld, LandmarksAreDrawnFromThePrior) {
  Scenario scenario = PointScenario();
  scenario.time = {30, 1.0 / 30};
  scenario.points->count = 20000;
  PointWorld world(scenario);
  const PointFrame frame = *world.Next();
  ASSERT_EQ(world.landmarks().size(), 20000u);
  double mean = 0, squares = 0, negative = 0;
  std::array<double, 48> cells{};
  for (const PointLandmark& landmark : world.landmarks()) {
    const double z = (landmark.X_W.w - 0.25) / 0.15;
    mean += z / 20000;
    squares += z * z;
    negative += landmark.X_W.w <= 0;
    const glm::dvec2 at = *world.Project(landmark, 0);
    ASSERT_GE(at.x, 4.5);
    ASSERT_LE(at.x, 634.5);
    const auto column = static_cast<std::size_t>((at.x - 4.5) / 630 * 8),
               row = static_cast<std::size_t>((at.y - 4.5) / 470 * 6);
    cells.at(row * 8 + column) += 1;
  }
  EXPECT_LT(std::abs(mean) * std::sqrt(20000), 5);
  const auto score = [&](double ratio) { return (squares / ratio / ratio - 20000) / std::sqrt(2 * 20000); };
  EXPECT_LT(std::abs(score(1)), 5);
  EXPECT_GT(std::abs(score(1.04)), 5) << "four per cent more would be noticed";
  const double expected = 20000 * 0.5 * std::erfc(0.25 / 0.15 / std::sqrt(2));
  EXPECT_LT(std::abs(negative - expected) / std::sqrt(expected), 5) << "what falls below 0 stays there";
  double chi2 = 0;
  for (const double cell : cells) chi2 += (cell - 20000.0 / 48) * (cell - 20000.0 / 48) / (20000.0 / 48);
  EXPECT_LT(chi2, 105);
}

// Widest field of view with positive depth: a corner of the margin is 89 degrees from the axis.
TEST(PointWorld, LandmarksOfAWideFisheyeAreInView) {
  Scenario scenario = PointScenario();
  scenario.camera = {640, 480, 200, 200, 319.5, 239.5};
  scenario.camera.lens = Lens::fisheye;
  scenario.points->margin_px = 64;
  scenario.points->count = 5000;
  PointWorld world(scenario);
  world.Next();
  for (const PointLandmark& landmark : world.landmarks()) EXPECT_TRUE(world.Project(landmark, 0));
}

// Inverse depth of a landmark: that in the camera of its first frame.
TEST(PointWorld, AnInverseDepthIsThatOfTheFirstView) {
  Scenario scenario = MovingPointScenario();
  scenario.points->inverse_depth_sigma = 0;
  PointWorld world(scenario);
  Play(world);
  for (const PointLandmark& landmark : world.landmarks()) {
    const Truth at = world.TruthAt(landmark.first_frame);
    const glm::dvec3 X_W = glm::dvec3(landmark.X_W) / landmark.X_W.w;
    EXPECT_NEAR((glm::conjugate(at.q_WC) * (X_W - at.p_WC)).z, 4, 1e-9);
  }
}

TEST(PointWorld, PointsLieWhereTheyShould) {
  for (const Landmarks landmarks : {Landmarks::room, Landmarks::plane, Landmarks::cloud}) {
    Scenario scenario = MovingPointScenario(landmarks);
    auto& motion = std::get<SampledMotion>(scenario.motion);
    motion.start = {{1, 2, 3}, Exp({0.3, -0.2, 0.5})};
    scenario.time.duration_s = 10;
    PointWorld world(scenario);
    Play(world);
    ASSERT_GT(world.landmarks().size(), 150u);
    std::set<int> faces;
    for (const PointLandmark& landmark : world.landmarks()) {
      EXPECT_EQ(landmark.X_W.w, 1);
      const glm::dvec3 from_start = glm::dvec3(landmark.X_W) - motion.start.p_WC;
      const glm::dvec3 in_camera = glm::conjugate(motion.start.q_WC) * from_start;
      const double most = std::max({std::abs(from_start.x), std::abs(from_start.y), std::abs(from_start.z)});
      if (landmarks == Landmarks::room) {
        EXPECT_NEAR(most, 2.5, 1e-12);
        for (int axis = 0; axis < 3; ++axis)
          if (std::abs(std::abs(from_start[axis]) - 2.5) < 1e-12) faces.insert(2 * axis + (from_start[axis] > 0));
      } else if (landmarks == Landmarks::cloud) {
        EXPECT_LE(most, 2.5);
      } else {
        EXPECT_NEAR(in_camera.z, 3, 1e-9);
        EXPECT_LE(std::abs(in_camera.x), 2.5);
      }
    }
    if (landmarks == Landmarks::room) {
      EXPECT_GE(faces.size(), 3u);
    }
  }
}

// Landmark ids after the camera turns aside and back within two seconds.
TEST(PointWorld, AForgottenLandmarkComesBackAsAnother) {
  const auto ids_at_start_and_end = [](int forget_after) {
    Scenario scenario = PointScenario(Landmarks::room);
    scenario.time = {30, 2};
    scenario.points->forget_after = forget_after;
    const glm::dquat ahead(1, 0, 0, 0), aside = Exp({0, 1.6, 0});
    ScriptedMotion motion;
    motion.keys = {{0, {{}, ahead}}, {0.4, {{}, aside}}, {1.6, {{}, aside}}, {2, {{}, ahead}}};
    scenario.motion = motion;
    PointWorld world(scenario);
    const std::vector<PointFrame> frames = Play(world);
    std::set<std::int64_t> start, both;
    for (const PointObservation& o : frames.front().observations) start.insert(o.id);
    for (const PointObservation& o : frames.back().observations)
      if (start.contains(o.id)) both.insert(o.id);
    return both.size();
  };
  EXPECT_EQ(ids_at_start_and_end(20), 0u);
  EXPECT_GT(ids_at_start_and_end(100), 50u);
}

TEST(PointWorld, WarnsWhenTheCameraLeavesTheRoom) {
  Scenario scenario = PointScenario(Landmarks::room);
  EXPECT_TRUE(PointWorld(scenario).Warnings().empty());
  std::get<SampledMotion>(scenario.motion).velocity = {0, 0, 3};
  EXPECT_THAT(PointWorld(scenario).Warnings(), ElementsAre("the camera leaves the room of points at frame 26"));
}

TEST(PointWorld, RefusesWhatItCannotPlay) {
  const auto complaint = [](const Scenario& scenario) -> std::string {
    try {
      PointWorld world(scenario);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "accepted";
  };
  Scenario scenario = PointScenario();
  scenario.points->count = 0;
  EXPECT_EQ(complaint(scenario), "point world: count = 0 must lie in 1 ... 1000000");
  scenario = PointScenario();
  scenario.camera = {640, 480, 200, 200, 319.5, 239.5};  // 112 degrees from the axis in the corners of the margin
  scenario.camera.lens = Lens::fisheye;
  EXPECT_THAT(complaint(scenario), HasSubstr("margin = 5 px"));
  scenario.points->landmarks = Landmarks::room;
  EXPECT_EQ(complaint(scenario), "accepted") << "what is beside or behind the camera is not in view";
  scenario.points.reset();
  EXPECT_THAT(complaint(scenario), HasSubstr("the world has meshes, not points"));
  PointWorld world(PointScenario());
  EXPECT_THROW(world.TruthAt(30), std::out_of_range);
  EXPECT_THROW(world.TruthAt(-1), std::out_of_range);
}

}  // namespace
}  // namespace sim
