// Camera rigs: keys of the scenario, cameras on one body, reproducible files, disparity.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "sim/motion/trajectory.h"
#include "sim/sequence/content.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "tests/unit/sim/small_world.h"
#include "tools/base/settings/settings.h"

namespace sim {
namespace {

using testing::HasSubstr;
using Settings = std::vector<std::pair<std::string, std::string>>;
constexpr char kLens[] = "width: 64, height: 48, fx: 52, fy: 52, cx: 31.5, cy: 23.5";

// SmallWorld with two cameras in place of one, `second` added to the second's keys, and a board in front of the wall.
Scenario Rig(const SmallWorld& world, const std::string& second = "position: [0.1, 0, 0]", Settings settings = {}) {
  std::string text = WallScenario();
  const std::size_t at = text.find("camera: "), end = text.find('\n', at);
  text.replace(at, end - at,
               std::string("cameras:\n  - {name: left, ") + kLens + "}\n  - {name: right, " + kLens +
                   (second.empty() ? "" : ", ") + second + "}");
  world.folder.Write("rig.yaml", text);
  settings.emplace_back("world.meshes", "[{file: wall.ply}, {file: wall.ply, scale: 0.25, position: [0.1, 0, -0.6]}]");
  return LoadScenario(world.folder.path() / "rig.yaml", settings);
}

std::string Problem(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

TEST(Rig, ItsFile) {
  const SmallWorld world;
  const Scenario s = Rig(world,
                         "position: [0.1, 0, 0], orientation: [0, 0.6, 0, 0.8], trigger_offset: 2 ms, sensor: "
                         "{exposure: 4 ms}");
  ASSERT_EQ(s.cameras.size(), 2u);
  EXPECT_EQ(s.cameras[0].name, "left");
  EXPECT_EQ(s.cameras[1].T_BC.p_WC.x, 0.1);
  EXPECT_NEAR(s.cameras[1].T_BC.q_WC.y, 0.6, 1e-15);
  EXPECT_EQ(s.cameras[1].trigger_offset_s, 0.002);
  EXPECT_EQ(s.cameras[1].sensor.exposure_s, 0.004);
  EXPECT_EQ(s.cameras[1].sensor.time_samples, 4) << "the common one's";
  EXPECT_EQ(s.cameras[0].sensor.exposure_s, 0.010);
  EXPECT_EQ(s.camera.fx, 52) << "the first one's";
  EXPECT_EQ(LoadScenario(world.folder.Write("again.yaml", s.resolved)).resolved, s.resolved);
  const auto rejected = [&](const std::string& second, const Settings& settings = {}) {
    return Problem([&] { Rig(world, second, settings); });
  };
  EXPECT_THAT(rejected("trigger_offset: 34 ms"), HasSubstr("cameras.1.trigger_offset = 0.034 s is not shorter than"));
  EXPECT_THAT(rejected("", {{"cameras.1.name", "left"}}), HasSubstr("another camera is called 'left' already"));
  EXPECT_THAT(rejected("", {{"cameras.1.name", "imu0"}}), HasSubstr("not 'imu0'"));
  EXPECT_THAT(rejected("", {{"camera", "{}"}}), HasSubstr("there is 'camera' already"));
  EXPECT_THAT(rejected("", {{"cameras", "[]"}}), HasSubstr("'cameras': there is none"));
  for (const auto& [second, why] : std::initializer_list<std::pair<const char*, const char*>>{
           {"position: [0.1, 0.01, 0]", "not straight to the right"},
           {"position: [-0.1, 0, 0]", "not straight to the right"},
           {"position: [0.1, 0, 0], orientation: [0, 0.6, 0, 0.8]", "turned against"},
           {"position: [0.1, 0, 0], trigger_offset: 1 ms", "different trigger offsets"},
           {"position: [0.1, 0, 0], distortion: {k1: 0.01}", "distorted"}})
    EXPECT_THAT(rejected(second, {{"truth", "[disparity]"}}), HasSubstr(why)) << second;
}

// Derivatives of a mounted frame against central differences of its pose, of fourth order with h = 1 ms.
TEST(Rig, AMountedFrameMovesAsTheBodySays) {
  const SmallWorld world;
  const Scenario s = LoadScenario(
      world.scenario(), {{"trajectory",
                          "{type: rpy, start: {position: [0, 0, 0], look_at: [0, 0, -2]}, angles: [0.4, 0.3, 0.5], "
                          "periods: [1 s, 1.3 s, 0.7 s]}"}});
  const Pose T_BC{{0.3, -0.2, 0.5}, glm::normalize(glm::dquat(0.7, 0.1, -0.5, 0.3))};
  const std::shared_ptr<const Trajectory> mounted = Mounted(TrajectoryOf(s), T_BC);
  constexpr double kStep = 1e-3, kTime = 0.13;
  const auto slope = [&](const auto& value) {
    return (8.0 * (value(kTime + kStep) - value(kTime - kStep)) -
            (value(kTime + 2 * kStep) - value(kTime - 2 * kStep))) /
           (12 * kStep);
  };
  const Motion m = mounted->At(kTime);
  const glm::dvec3 v = slope([&](double t) { return mounted->At(t).pose.p_WC; }),
                   a = slope([&](double t) { return mounted->At(t).v_WC; }),
                   alpha = slope([&](double t) { return mounted->At(t).w_WC_C; });
  const glm::dquat turn = glm::conjugate(m.pose.q_WC) * slope([&](double t) { return mounted->At(t).pose.q_WC; });
  EXPECT_LT(glm::length(v - m.v_WC), 1e-8);
  EXPECT_LT(glm::length(a - m.a_WC), 1e-7);
  EXPECT_LT(glm::length(alpha - m.alpha_WC_C), 1e-7);
  EXPECT_LT(glm::length(2.0 * glm::dvec3(turn.x, turn.y, turn.z) - m.w_WC_C), 1e-8);
}

// A rig's first camera, at the body, gives the image of a scenario with one camera. The second camera at the same pose
// has the same depth and other noise.
TEST(Rig, ACameraAtTheBodyIsAsIfAlone) {
  const SmallWorld world;
  const Scenario rig = Rig(world, "");
  const Scenario alone =
      LoadScenario(world.scenario(),
                   {{"world.meshes", "[{file: wall.ply}, {file: wall.ply, scale: 0.25, position: [0.1, 0, -0.6]}]"}});
  const Simulator two(rig, 2), one(alone, 2);
  EXPECT_EQ(two.Cameras().size(), 2u);
  EXPECT_EQ(one.Cameras().size(), 1u);
  EXPECT_EQ(two.Render(4).image.data, one.Render(4).image.data);
  EXPECT_EQ(two.Cameras()[1].Depth(4), one.Depth(4));
  EXPECT_NE(two.Cameras()[1].Render(4).image.data, one.Render(4).image.data) << "its noise is its own";
}

// Files of the first camera alone, as for campaigns: those of a scenario with one camera.
TEST(Rig, TheFirstCameraAlone) {
  const SmallWorld world;
  const Simulator two(Rig(world), 2);
  std::vector<std::string> alone, rig;
  for (const StreamFile& file : FrameFiles(two, {Layout::tum, 0, 9, "test", false}, 4)) alone.push_back(file.path);
  for (const StreamFile& file : FrameFiles(two, {Layout::tum, 0, 9, "test"}, 4)) rig.push_back(file.path);
  EXPECT_THAT(alone, testing::ElementsAre("rgb/0.133333333.png", "depth/0.133333333.png"));
  EXPECT_THAT(rig, testing::ElementsAre("left/rgb/0.133333333.png", "left/depth/0.133333333.png",
                                        "right/rgb/0.133333333.png", "right/depth/0.133333333.png"));
}

TEST(Rig, FilesDependNeitherOnThreadsNorOnTheRange) {
  const SmallWorld world;
  const Settings truth = {{"truth", "[depth, flow, disparity, imu, instance]"}, {"imu.rate", "1 kHz"}};
  const Scenario rig = Rig(world, "position: [0.1, 0, 0]", truth);
  const auto write = [&](const std::string& name, int jobs, std::int64_t first, Layout layout) {
    const Simulator simulator(rig, jobs);
    SequenceWriter writer(simulator, world.folder.path() / name, {layout, first, 6, "test"}, jobs,
                          SequenceWriter::Start::fresh);
    while (writer.Wait() > 0) {
    }
    writer.Finish();
    auto tree = Tree(world.folder.path() / name);
    tree.erase(kJournalName);
    return tree;
  };
  for (const Layout layout : {Layout::tum, Layout::euroc}) {
    const std::string name = ToString(layout);
    const auto one = write(name + "1", 1, 0, layout), three = write(name + "3", 3, 0, layout);
    EXPECT_TRUE(one == three) << name;
    int frames = 0;
    for (const auto& [path, bytes] : write(name + "part", 2, 3, layout)) {
      if (!path.ends_with(".png") && !path.ends_with(".exr") && !path.ends_with(".flo")) continue;
      EXPECT_TRUE(one.at(path) == bytes) << path;
      ++frames;
    }
    EXPECT_GT(frames, 3 * 6);
  }
}

// Disparity against cam1's depth: 52 px * 0.1 m / Z1 to 1e-3 px where the point is visible in both cameras, a nearer
// surface in cam1 where it is occluded. 1 / Z is linear along a row of each of the two planes.
TEST(Rig, DisparityAgainstTheSecondCamerasDepth) {
  const SmallWorld world;
  const Scenario rig = Rig(world, "position: [0.1, 0, 0]", {{"truth", "[disparity]"}});
  const Simulator left(rig, 2), right = left.Cameras()[1];
  int seen = 0, hidden = 0;
  for (const std::int64_t index : {0, 4, 8}) {
    const std::vector<StreamFile> files = FrameFiles(left, {Layout::tum, 0, 9, "test"}, index);
    std::vector<std::uint8_t> mask_file;
    std::string exr;
    for (const StreamFile& file : files) {
      if (file.path.starts_with("left/disparity_occlusion/")) mask_file = file.bytes;
      if (file.path.starts_with("left/disparity/")) exr.assign(file.bytes.begin(), file.bytes.end());
      EXPECT_FALSE(file.path.starts_with("right/disparity")) << "it is the first camera's";
    }
    const cv::Mat mask = cv::imdecode(mask_file, cv::IMREAD_UNCHANGED);
    const std::vector<float> Z0 = left.Depth(index), Z1 = right.Depth(index);
    // Uncompressed EXR: the rows are the file's last bytes, each after its number and length.
    std::vector<float> disparity(64 * 48);
    const std::size_t row = 8 + 64 * 4, start = exr.size() - 48 * row;
    for (std::size_t y = 0; y < 48; ++y) std::memcpy(&disparity[64 * y], exr.data() + start + y * row + 8, 64 * 4);
    for (std::size_t i = 0; i < disparity.size(); ++i) {
      if (Z0[i] == 0) {
        EXPECT_EQ(disparity[i], 0);
        continue;
      }
      const double d = static_cast<double>(disparity[i]), x = static_cast<double>(i % 64) - d;
      const bool is_hidden = mask.data[i] != 0;
      if (!(x >= 0 && x < 63)) {
        EXPECT_TRUE(is_hidden || (x > -0.5 && x < 63.5));
        continue;
      }
      const auto at = static_cast<std::size_t>(x);
      const double w0 = 1 / static_cast<double>(Z1[i / 64 * 64 + at]),
                   w1 = 1 / static_cast<double>(Z1[i / 64 * 64 + at + 1]);
      const double expected = 52 * 0.1 * (w0 + (x - static_cast<double>(at)) * (w1 - w0));
      if (std::abs(w1 - w0) > 0.02 || !std::isfinite(expected)) continue;  // between two surfaces
      if (is_hidden) {
        EXPECT_GT(expected, d + 0.5) << "something nearer";
        ++hidden;
      } else {
        EXPECT_NEAR(expected, d, 1e-3) << i;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 4000);
  EXPECT_GT(hidden, 50);
}

}  // namespace
}  // namespace sim
