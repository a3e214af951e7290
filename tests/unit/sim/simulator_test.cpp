#include "sim/simulator.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sim/motion/sampled.h"
#include "sim/world/scene.h"
#include "tests/unit/sim/small_world.h"

namespace sim {
namespace {

using testing::HasSubstr;

TEST(Simulator, FramesAndTruthAtMidExposure) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario());
  Simulator simulator(scenario, 1);
  ASSERT_EQ(simulator.frame_count(), 9);
  const SampledTrajectory trajectory(std::get<SampledMotion>(scenario.motion), scenario.seed, 1);
  std::int64_t count = 0;
  while (const std::optional<Frame> frame = simulator.Next()) {
    EXPECT_EQ(frame->index, count);
    EXPECT_EQ(frame->stamp_ns, std::llround(static_cast<double>(count) * 1e9 / 30));
    EXPECT_EQ(frame->image.width, 64);
    EXPECT_EQ(frame->image.height, 48);
    EXPECT_EQ(frame->image.channels, 3);
    const Motion motion = trajectory.At(static_cast<double>(frame->stamp_ns) * 1e-9);
    EXPECT_EQ(frame->truth.p_WC, motion.pose.p_WC);
    EXPECT_EQ(frame->truth.v_WC, motion.v_WC);
    EXPECT_EQ(frame->truth.w_WC_C, motion.w_WC_C);
    EXPECT_GE(frame->truth.q_WC.w, 0);
    EXPECT_NEAR(std::abs(glm::dot(frame->truth.q_WC, motion.pose.q_WC)), 1, 1e-15);
    ++count;
  }
  EXPECT_EQ(count, 9);
  EXPECT_THROW(simulator.Render(9), std::out_of_range);
  EXPECT_THROW(simulator.TruthAt(-1), std::out_of_range);
}

// Z of each pixel's centre in closed form: a wall at z = -2 from the true pose.
TEST(Simulator, DepthIsThatOfTheTruthsPose) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  const std::vector<float> depth = simulator.Depth(4);
  const Truth truth = simulator.TruthAt(4);
  ASSERT_EQ(depth.size(), 64u * 48u);
  int seen = 0;
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      const glm::dvec2 xy = simulator.camera().Undistort({u, v});
      const glm::dvec3 ray = truth.q_WC * glm::dvec3(xy.x, xy.y, 1);
      const double z = (-2 - truth.p_WC.z) / ray.z;
      const glm::dvec3 hit = truth.p_WC + z * ray;
      if (std::abs(hit.x) > 1.99 || std::abs(hit.y) > 1.49) continue;
      EXPECT_NEAR(static_cast<double>(depth[static_cast<std::size_t>(v * 64 + u)]), z, 2e-6 * z);
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

// Depth with the rasteriser as engine is traced by rays: equal at the edges of triangles and of the wall too.
TEST(Simulator, DepthIsOfRays) {
  const SmallWorld world;
  const std::vector<std::pair<std::string, std::string>> wide = {
      {"camera.fx", "30"}, {"camera.fy", "30"}, {"camera.distortion", "{k1: -0.2, k2: 0.03}"}};
  Scenario scenario = LoadScenario(world.scenario(), wide);
  const Simulator rays(scenario, 1);
  scenario.render.engine = Engine::rasteriser;
  std::unique_ptr<const Simulator> raster;
  try {
    raster = std::make_unique<const Simulator>(scenario, 1);
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << error.what();
  }
  for (const std::int64_t k : {0, 4, 8}) EXPECT_EQ(raster->Depth(k), rays.Depth(k)) << k;
}

TEST(Simulator, SameBytesInAnyOrder) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario());
  const Simulator one(scenario, 1), three(scenario, 3);
  std::vector<Image> images;
  for (std::int64_t k = 0; k < one.frame_count(); ++k) images.push_back(one.Render(k).image);
  for (std::int64_t k = three.frame_count(); k-- > 0;) {
    EXPECT_EQ(three.Render(k).image.data, images[static_cast<std::size_t>(k)].data) << k;
    EXPECT_EQ(three.Depth(k), one.Depth(k)) << k;
  }
  std::vector<Image> at_once(4);
  {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < at_once.size(); ++k) {
      threads.emplace_back([&, k] { at_once[k] = three.Render(static_cast<std::int64_t>(k)).image; });
    }
  }
  for (std::size_t k = 0; k < at_once.size(); ++k) EXPECT_EQ(at_once[k].data, images[k].data);
  EXPECT_NE(images[0].data, images[1].data);
  EXPECT_NE(Simulator(LoadScenario(world.scenario(), {{"seed", "6"}}), 1).Render(0).image.data, images[0].data);
}

TEST(Simulator, ADurationChangesNoFrame) {
  const SmallWorld world;
  const Simulator whole(LoadScenario(world.scenario()), 1),
      part(LoadScenario(world.scenario(), {{"time.duration", "0.1 s"}}), 1);
  ASSERT_EQ(part.frame_count(), 3);
  for (std::int64_t k = 0; k < 3; ++k) EXPECT_EQ(part.Render(k).image.data, whole.Render(k).image.data) << k;
}

// Motion blur in closed form: the camera moves sideways past a step edge between black and white, at constant speed.
// With a linear response and no noise the blurred edge is a ramp, as wide as the path of the edge's image during the
// exposure.
TEST(Simulator, BlurIsARampOfTheRightWidthAndPlace) {
  const TemporaryFolder folder;
  const auto half = [](const std::string& x0, const std::string& x1, const std::string& color) {
    std::string vertices;
    for (const std::string& xy : {x0 + " -9", x1 + " -9", x1 + " 9", x0 + " 9"}) vertices += xy + " -2 " + color + "\n";
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty "
           "uchar red\n"
           "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int "
           "vertex_indices\nend_header\n" +
           vertices + "4 0 1 2 3\n";
  };
  folder.Write("black.ply", half("-9", "0", "0 0 0"));
  folder.Write("white.ply", half("0", "9", "255 255 255"));
  const auto file = folder.Write("edge.yaml", R"(
world: {meshes: [{file: black.ply}, {file: white.ply}], lights: [{type: ambient, radiance: [1, 1, 1]}]}
camera: {width: 101, height: 21, fx: 100, fy: 100, cx: 50, cy: 10}
sensor: {exposure: 30 ms, time_samples: 128, shot_noise: false, read_noise: 0, response: linear, color: false}
time: {rate: 30 Hz, duration: 0.1 s}
trajectory:
  type: sampled
  start: {position: [-0.1, 0, 0], look_at: [-0.1, 0, -2], velocity: [10, 0, 0]}
  position_noise: 0
  orientation_noise: 0
)");
  const Simulator simulator(LoadScenario(file), 1);
  // At the stamp of frame 0 the edge is at u = 50 + 100 * 0.1 / 2 = 55; it moves by 100 * 10 / 2 * 0.03 = 15 px during
  // the exposure.
  const Image image = simulator.Render(0).image;
  double worst = 0;
  for (int u = 0; u < 101; ++u) {
    double mean = 0;
    for (int v = 0; v < 21; ++v) mean += image.data[static_cast<std::size_t>(v * 101 + u)] / (255.0 * 21);
    // The mean over a pixel of the ramp from 47.5 to 62.5.
    const auto integral = [](double x) {
      const double s = std::clamp((x - 47.5) / 15, 0.0, 1.0);
      return 15 * s * s / 2 + std::max(0.0, x - 62.5);
    };
    worst = std::max(worst, std::abs(mean - (integral(u + 0.5) - integral(u - 0.5))));
  }
  // 128 samples give steps of 1/128, rounding to bytes half of 1/255, the jitter in a pixel less.
  EXPECT_LT(worst, 0.02);
}

double Mean(const Image& image) {
  double sum = 0;
  for (const std::uint8_t code : image.data) sum += code / (255.0 * static_cast<double>(image.data.size()));
  return sum;
}

TEST(Simulator, AutomaticExposureBringsADarkWallToItsTarget) {
  const SmallWorld world;
  const std::vector<std::pair<std::string, std::string>> dark = {
      {"world.lights.0.radiance", "[0.15, 0.15, 0.15]"},
      {"sensor.shot_noise", "false"},
      {"sensor.read_noise", "0"},
      {"sensor.auto_exposure", "{on: true, target: 0.4, speed: 0.6, longest: 20 ms, highest_gain: 16}"}};
  const Simulator simulator(LoadScenario(world.scenario(), dark), 1), again(LoadScenario(world.scenario(), dark), 2);
  const Frame first = simulator.Render(0), last = simulator.Render(8);
  EXPECT_EQ(first.setting.exposure_s, 0.010);
  EXPECT_EQ(first.setting.gain, 1);
  EXPECT_LT(Mean(first.image), 0.33);
  EXPECT_EQ(last.setting.exposure_s, 0.020);
  EXPECT_GT(last.setting.gain, 1);
  EXPECT_NEAR(Mean(last.image), 0.4, 0.02);  // the metered image is an eighth as wide
  EXPECT_EQ(simulator.SettingOf(8).gain, last.setting.gain);
  EXPECT_EQ(again.Render(8).image.data, last.image.data);
  EXPECT_THROW(simulator.SettingOf(9), std::out_of_range);
}

// Automatic exposure under a flickering lamp: the target where each frame spans whole periods, in its exposure or from
// its first row to its last. The radiance at the stamp alone is not metered.
TEST(Simulator, AutomaticExposureMetersTheWholeOfAnExposure) {
  const SmallWorld world;
  for (const auto& [exposure, readout] : {std::pair<std::string, std::string>{"10 ms", "0 ms"}, {"1 ms", "20 ms"}}) {
    const Simulator simulator(
        LoadScenario(world.scenario(),
                     {{"world.lights",
                       "[{type: point, position: [0, 0, 0], intensity: [2, 2, 2], "
                       "flicker: {frequency: 100 Hz, depth: 0.9}}]"},
                      {"sensor.rolling_shutter", readout},
                      {"sensor.exposure", exposure},
                      {"sensor.auto_exposure", "{on: true, speed: 1, shortest: " + exposure + ", longest: " + exposure +
                                                   ", highest_gain: 100, target: 0.45}"}}),
        1);
    for (std::int64_t k = 1; k < simulator.frame_count(); ++k)
      EXPECT_NEAR(Mean(simulator.Render(k).image), 0.45, 0.05) << exposure << ", frame " << k;
  }
}

TEST(Simulator, AHandBeforeTheLensLeavesTheNoiseAndTheTruth) {
  const SmallWorld world;
  const auto with = [&](const std::string& covered) {
    return Simulator(LoadScenario(world.scenario(),
                                  {{"time.rate", "30 Hz"}, {"sensor.read_noise", "80 e"}, {"sensor.covered", covered}}),
                     1);
  };
  const Simulator open = with("[]"),
                  covered = with("[{from: 60 ms, until: 0.1 s}]");  // frame 2 alone (66.7 ms)
  for (std::int64_t k = 0; k < 5; ++k) {
    const Frame a = open.Render(k), b = covered.Render(k);
    EXPECT_EQ(a.image.data == b.image.data, k != 2) << k;
    EXPECT_EQ(open.Depth(k), covered.Depth(k));
  }
  const Image dark = covered.Render(2).image;
  // Half of the read noise is below 0 and black; the rest is 0.008 of the scale, 20 of 255 after the sRGB curve.
  const auto black = std::ranges::count(dark.data, 0);
  EXPECT_NEAR(static_cast<double>(black) / static_cast<double>(dark.data.size()), 0.5, 0.05);
  EXPECT_GT(*std::ranges::max_element(dark.data), 20);
  EXPECT_LT(*std::ranges::max_element(dark.data), 70);
  try {
    with("[{from: 1 s, until: 0.5 s}]");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("sensor.covered.until = 0.5 must be above from"));
  }
}

TEST(Simulator, ExtentIsThatOfTheWall) {
  const SmallWorld world;
  const Simulator simulator(LoadScenario(world.scenario()), 1);
  EXPECT_EQ(simulator.extent().low, glm::dvec3(-2, -1.5, -2));
  EXPECT_EQ(simulator.extent().high, glm::dvec3(2, 1.5, -2));
  EXPECT_EQ(simulator.extent().triangles, 2u * 16 * 12);
  EXPECT_EQ(simulator.extent().texture_bytes, 0u);
}

TEST(Simulator, FaultsOfTheInputAreNamed) {
  const SmallWorld world;
  std::filesystem::remove(world.folder.path() / "wall.ply");
  try {
    Simulator(LoadScenario(world.scenario()), 1);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("wall.ply"));
  }
  EXPECT_THROW(Simulator(LoadScenario(SmallWorld().scenario()), 0), std::exception);
}

}  // namespace
}  // namespace sim
