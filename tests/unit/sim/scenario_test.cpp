#include "sim/scenario/scenario.h"

#include <gmock/gmock.h>

#include <glm/geometric.hpp>
#include <string>

#include "sim/motion/so3.h"
#include "sim/scenario/readers.h"
#include "tests/unit/sim/small_world.h"
#include "tools/base/settings/settings.h"

namespace sim {
namespace {

using testing::HasSubstr;

std::string Message(const std::filesystem::path& path,
                    const std::vector<std::pair<std::string, std::string>>& overrides = {}) {
  try {
    LoadScenario(path, overrides);
  } catch (const settings::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Scenario, EveryKeyIsRead) {
  const TemporaryFolder folder;
  const auto file = folder.Write("s.yaml", R"(
name: all
seed: 18446744073709551615
world:
  meshes: [{file: a/b.obj, position: [1 cm, 2, 3], orientation: [0, 0.6, 0, 0.8], scale: 0.01}]
  lights:
    - {type: ambient, radiance: [0.1, 0.2, 0.3]}
    - {type: sun, direction: [0, -1, 0], irradiance: [1, 2, 3]}
    - {type: point, position: [1, 2, 3], intensity: [4, 5, 6]}
    - {type: rectangle, corner: [1, 2, 3], side_u: [1, 0, 0], side_v: [0, 0, 2], radiance: [7, 8, 9]}
  background: [0.1, 0.1, 0.2]
camera: {width: 320, height: 240, fx: 260 px, fy: 261, cx: 159.5, cy: 119.5, distortion: {k1: 0.1, k2: -0.01, p1: 0.001, p2: 0.002, k3: 0.003}}
sensor: {exposure: 8 ms, time_samples: 7, white: 2, full_well: 5000 e, shot_noise: false, read_noise: 3 e, response: linear, color: false}
render: {rays_per_time_sample: 3}
time: {rate: 20 Hz, duration: 1.5 s}
truth: [flow, imu, surface_id]
landmarks: {count: 7}
imu: {rate: 400 Hz, position: [1 cm, 0, 2], orientation: [0, 0.6, 0, 0.8], gravity: [0, 0, -9.8], reading: mean, gyroscope_noise: 1e-3, accelerometer_noise: 0.02, gyroscope_walk: 1e-5, accelerometer_walk: 3e-3}
trajectory:
  type: sampled
  start: {position: [0, 1, 0], look_at: [0, 1, -5], velocity: [1 cm/s, 2, 3], angular_rate: [90 deg/s, 0, 0], velocity_sigma: 5 cm/s, angular_rate_sigma: 0.2}
  position_noise: 0.3 m/s^1.5
  orientation_noise: 0.4 rad/s^1.5
  position_return: 1.5 1/s
  orientation_return: 2.5
  knot_step: 5 ms
odometry: {what: [ever]}
prior: 3
)");
  const Scenario s = LoadScenario(file);
  EXPECT_EQ(s.name, "all");
  EXPECT_EQ(s.seed, 18446744073709551615u);
  ASSERT_EQ(s.world.meshes.size(), 1u);
  EXPECT_EQ(s.world.meshes[0].file, folder.path() / "a/b.obj");
  EXPECT_EQ(s.world.meshes[0].position, glm::dvec3(0.01, 2, 3));
  EXPECT_DOUBLE_EQ(s.world.meshes[0].orientation.y, 0.6);
  EXPECT_DOUBLE_EQ(s.world.meshes[0].orientation.w, 0.8);
  EXPECT_EQ(s.world.meshes[0].scale, 0.01);
  ASSERT_EQ(s.world.lights.size(), 4u);
  EXPECT_EQ(std::get<AmbientLight>(s.world.lights[0]).radiance, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(std::get<SunLight>(s.world.lights[1]).irradiance, glm::dvec3(1, 2, 3));
  EXPECT_EQ(std::get<PointLight>(s.world.lights[2]).intensity, glm::dvec3(4, 5, 6));
  EXPECT_EQ(std::get<RectLight>(s.world.lights[3]).side_v, glm::dvec3(0, 0, 2));
  EXPECT_EQ(s.world.background, glm::dvec3(0.1, 0.1, 0.2));
  EXPECT_EQ(s.camera.width, 320);
  EXPECT_EQ(s.camera.fx, 260);
  EXPECT_EQ(s.camera.p2, 0.002);
  EXPECT_EQ(s.sensor.exposure_s, 0.008);
  EXPECT_EQ(s.sensor.time_samples, 7);
  EXPECT_EQ(s.sensor.full_well_e, 5000);
  EXPECT_FALSE(s.sensor.shot_noise);
  EXPECT_EQ(s.sensor.response, Response::linear);
  EXPECT_FALSE(s.sensor.color);
  EXPECT_EQ(s.render.rays_per_time_sample, 3);
  EXPECT_EQ(s.time.rate_hz, 20);
  EXPECT_EQ(s.time.duration_s, 1.5);
  const auto& motion = std::get<SampledMotion>(s.motion);
  EXPECT_EQ(motion.velocity, glm::dvec3(0.01, 2, 3));
  EXPECT_DOUBLE_EQ(motion.angular_rate.x, std::acos(-1.0) / 2);
  EXPECT_EQ(motion.velocity_sigma, 0.05);
  EXPECT_EQ(motion.angular_rate_sigma, 0.2);
  EXPECT_EQ(motion.orientation_noise, 0.4);
  EXPECT_EQ(motion.position_return, 1.5);
  EXPECT_EQ(motion.orientation_return, 2.5);
  EXPECT_EQ(motion.knot_step_s, 0.005);
  EXPECT_EQ(s.truth.streams, (std::set<TruthStream>{TruthStream::flow, TruthStream::surface_id, TruthStream::imu}));
  EXPECT_EQ(s.truth.landmarks, 7);
  const ImuParams& imu = s.truth.imu;
  EXPECT_EQ(imu.rate_hz, 400);
  EXPECT_EQ(imu.T_CI.p_WC, glm::dvec3(0.01, 0, 2));
  EXPECT_DOUBLE_EQ(imu.T_CI.q_WC.y, 0.6);
  EXPECT_EQ(imu.gravity_W, glm::dvec3(0, 0, -9.8));
  EXPECT_EQ(imu.reading, ImuReading::mean);
  EXPECT_EQ(imu.gyroscope_noise, 1e-3);
  EXPECT_EQ(imu.accelerometer_noise, 0.02);
  EXPECT_EQ(imu.gyroscope_walk, 1e-5);
  EXPECT_EQ(imu.accelerometer_walk, 3e-3);

  // Round trip: the resolved text, read again, gives the same scenario.
  const Scenario again = LoadScenario(folder.Write("again.yaml", s.resolved));
  EXPECT_EQ(again.resolved, s.resolved);
  EXPECT_THAT(s.resolved, testing::Not(HasSubstr("odometry")));
}

// A whole scenario with one section of the world's lights and one of the renderer.
std::string WithLight(const std::string& lights, const std::string& render = "{}") {
  return R"(
world: {meshes: [{file: a.obj}], lights: [)" +
         lights + R"(]}
camera: {width: 320, height: 240, fx: 260, fy: 261, cx: 159.5, cy: 119.5}
time: {rate: 20 Hz, duration: 1 s}
trajectory: {type: sampled, start: {position: [0, 1, 0], look_at: [0, 1, -5]}, position_noise: 0.3, orientation_noise: 0.4}
render: )" +
         render;
}

TEST(Scenario, KeysOfLight) {
  const TemporaryFolder folder;
  Scenario s = LoadScenario(folder.Write("plain.yaml", WithLight("")));
  EXPECT_EQ(s.render.light, LightMode::direct);
  EXPECT_FALSE(s.world.sky.has_value());
  s = LoadScenario(folder.Write(
      "light.yaml", WithLight(R"(
    {type: point, position: [1, 2, 3], intensity: [4, 5, 6], flicker: {frequency: 100 Hz, depth: 0.3, phase: 90 deg}},
    {type: rectangle, corner: [1, 2, 3], side_u: [1, 0, 0], side_v: [0, 0, 2], radiance: [7, 8, 9], visible: true, flicker: {frequency: 0.12 kHz, depth: 1}},
    {type: sky, file: sky.hdr, strength: 3, turn: 45 deg})",
                              "{light: baked, bake: {spacing: 20 cm, min_spacing: 5 mm, paths: 64, lamp_rays: 32}}")));
  EXPECT_EQ(s.render.light, LightMode::baked);
  EXPECT_EQ(s.render.bake.spacing_m, 0.2);
  EXPECT_EQ(s.render.bake.min_spacing_m, 0.005);
  EXPECT_EQ(s.render.bake.paths, 64);
  EXPECT_EQ(s.render.bake.lamp_rays, 32);
  EXPECT_EQ(s.render.light_folders.at(0), folder.path() / ".vobench-cache");
  const auto& point = std::get<PointLight>(s.world.lights.at(0));
  EXPECT_EQ(point.flicker.frequency_hz, 100);
  EXPECT_EQ(point.flicker.depth, 0.3);
  EXPECT_NEAR(point.flicker.phase, 0.25, 1e-15);
  const auto& rect = std::get<RectLight>(s.world.lights.at(1));
  EXPECT_TRUE(rect.visible);
  EXPECT_EQ(rect.flicker.frequency_hz, 120);
  ASSERT_EQ(s.world.lights.size(), 2u);
  ASSERT_TRUE(s.world.sky.has_value());
  EXPECT_EQ(s.world.sky->file, folder.path() / "sky.hdr");
  EXPECT_EQ(s.world.sky->strength, 3);
  EXPECT_NEAR(s.world.sky->turn, 0.125, 1e-15);
  s = LoadScenario(folder.Write("blue.yaml", WithLight("{type: sky, zenith: [0, 0, 1], horizon: [1, 1, 1]}")));
  EXPECT_EQ(s.world.sky->zenith, glm::dvec3(0, 0, 1));
  EXPECT_EQ(s.world.sky->ground, glm::dvec3(1)) << "as the horizon where it is not given";
  s = LoadScenario(folder.Write("even.yaml", WithLight("{type: sky, radiance: [1, 2, 3]}")));
  EXPECT_EQ(s.world.sky->ground, glm::dvec3(1, 2, 3));
}

TEST(Scenario, APresetIsWhatTheOtherKeysBeginWith) {
  const SmallWorld world;
  const Scenario kinect = LoadScenario(world.scenario(), {{"sensor", "{preset: kinect, read_noise: 3 e}"}});
  EXPECT_EQ(kinect.sensor.readout_s, 0.026);
  EXPECT_EQ(kinect.sensor.exposure_s, 0.015);
  EXPECT_EQ(kinect.sensor.processing.denoise_range, 0.1);
  EXPECT_EQ(kinect.sensor.mosaic, Mosaic::demosaiced);
  EXPECT_EQ(kinect.sensor.read_noise_e, 3) << "set beside it";
  const Scenario icl = LoadScenario(world.scenario(), {{"sensor", "{preset: icl_nuim}"}});
  EXPECT_EQ(icl.sensor.exposure_s, 0);
  EXPECT_EQ(icl.sensor.full_well_e, 4000);
  EXPECT_THAT(icl.resolved, HasSubstr("icl_nuim"));
  EXPECT_THAT(LoadScenario(world.scenario()).resolved, testing::Not(HasSubstr("preset")));
  EXPECT_THAT(Message(world.scenario(), {{"sensor", "{preset: leica}"}}), HasSubstr("leica"));
}

TEST(Scenario, TheResponseIsThatOfAFileBesideIt) {
  const SmallWorld world;
  const auto file = world.folder.Write("pcalib.txt", "0 10 40\n");
  EXPECT_EQ(LoadScenario(world.scenario(), {{"sensor.response_file", "pcalib.txt"}}).sensor.light_of_code,
            (std::vector<double>{0, 0.25, 1}));
  world.folder.Write("pcalib.txt", "0 10 4\n");
  EXPECT_THAT(Message(world.scenario(), {{"sensor.response_file", "pcalib.txt"}, {"sensor.white", "-1"}}),
              testing::AllOf(HasSubstr(file.string() + ":1:6: 4 is less"), HasSubstr("sensor.white")));
}

TEST(Scenario, LightThatMakesNoSense) {
  const TemporaryFolder folder;
  const std::string message = Message(
      folder.Write("bad.yaml", WithLight(R"(
    {type: point, position: [1, 2, 3], intensity: [4, 5, 6], flicker: {depth: 0.3}},
    {type: point, position: [1, 2, 3], intensity: [4, 5, 6], flicker: {frequency: 100, depth: 1.5}},
    {type: sun, direction: [0, -1, 0], irradiance: [1, 2, 3], flicker: {depth: 0.3}},
    {type: sky, radiance: [1, 1, 1], file: sky.hdr},
    {type: sky, radiance: [1, 1, 1], turn: 3 deg})",
                                         "{light: fast, bake: {spacing: 1 cm, min_spacing: 2 cm, paths: 100}}")));
  for (const char* part : {"needs a frequency", "'world.lights.1.flicker.depth'", "'flicker'", "either 'radiance'",
                           "a sky already", "only a sky from a file", "'fast'",
                           "min_spacing = 0.02 m must not be above spacing", "'100' must be a power of two"}) {
    EXPECT_THAT(message, HasSubstr(part));
  }
}

TEST(Scenario, ScriptedAndRecordedMotion) {
  const SmallWorld world;
  const std::string base = WallScenario().substr(0, WallScenario().find("time:"));
  const auto scripted = world.folder.Write("scripted.yaml", base + R"(
trajectory:
  type: scripted
  keys:
    - {time: 0 s, position: [0, 1, 0], look_at: [0, 1, -2]}
    - {time: 500 ms, position: [0.1, 1, 0], look_at: [0.1, 1, -2], roll: 10 deg}
    - {time: 2 s, position: [0.2, 1, 0], orientation: [1, 0, 0, 0]}
)");
  const Scenario a = LoadScenario(scripted);
  EXPECT_EQ(a.time.duration_s, 2) << "up to the last key";
  EXPECT_EQ(std::get<ScriptedMotion>(a.motion).keys.size(), 3u);
  EXPECT_EQ(std::get<ScriptedMotion>(a.motion).keys[1].t_s, 0.5);
  EXPECT_THAT(Message(scripted, {{"time.duration", "3 s"}}), HasSubstr("--set time.duration: time.duration = 3 s "));

  const Scenario b = LoadScenario(world.folder.Write("recorded.yaml", base + R"(
time: {duration: 1 s}
trajectory: {type: recorded, file: f.txt, start_time: 2 s, start_pose: {position: [1, 2, 3], look_at: [1, 2, 0]}}
)"));
  EXPECT_EQ(std::get<RecordedMotion>(b.motion).file, world.folder.path() / "f.txt");
  EXPECT_EQ(std::get<RecordedMotion>(b.motion).start_time_s, 2);
  EXPECT_EQ(std::get<RecordedMotion>(b.motion).start_pose->p_WC, glm::dvec3(1, 2, 3));
}

TEST(Scenario, AllProblemsAtOnce) {
  const TemporaryFolder folder;
  const std::string file =
      folder
          .Write("bad.yaml",
                 "world:\n"
                 "  lights: [{type: torch}, {type: sun, direction: [0, 0, 0], irradiance: [-1, 0, 0]}]\n"
                 "camera: {width: 640, hieght: 480, fx: 3 ms, fy: 525, cx: 319.5, cy: 239.5}\n"
                 "sensor: {exposure: 50 ms, exposhure: 3, read_noise: -1}\n"
                 "time: {rate: 30 Hz}\n"
                 "trajectory:\n"
                 "  type: scripted\n"
                 "  keys:\n"
                 "    - {time: 1 s, position: [0, 0, 0], look_at: [0, 0, 0]}\n"
                 "    - {time: 0.5 s, position: [0, 0], roll: 3 deg}\n")
          .string();
  const std::string message = Message(file);
  for (const char* problem : {
           ":2:19: 'world.lights.0.type': 'torch' is not known; known: ",
           ":2:50: 'direction' has no length",
           ":2:74: 'world.lights.1.irradiance': '-1' must lie in 0 ... 1000000",
           ": missing key 'camera.height'",
           ":3:22: unknown key 'hieght'; did you mean 'height'?",
           ":3:39: 'camera.fx': '3 ms' is not a number of pixels: expected a number with px",
           ":4:20: sensor.exposure = 0.05 s is longer than the time between two frames",
           ":4:27: unknown key 'exposhure'; did you mean 'exposure'?",
           ":4:53: 'sensor.read_noise': '-1' must be at least 0 e",
           ":9:14: 'time': the first key pose must be at 0 s",
           ":9:49: 'look_at' is where the camera is",
           ":10:14: 'time': the times of key poses must increase, but 0.5 s comes after 1 s",
           ":10:31: 'trajectory.keys.1.position': expected 3 numbers, not 2",
           ":10:45: 'roll' goes with 'look_at', which is not there",
           "'world.meshes': the world is empty",
       }) {
    EXPECT_THAT(message, HasSubstr(problem));
  }
}

TEST(Scenario, TurnsThatASplineCannotFollow) {
  const SmallWorld world;
  const std::string base = WallScenario().substr(0, WallScenario().find("time:"));
  const auto file = world.folder.Write("s.yaml", base + R"(
trajectory:
  type: scripted
  keys:
    - {time: 0 s, position: [0, 1, 0], look_at: [0, 1, -2]}
    - {time: 1 s, position: [0, 1, 0], look_at: [0, 1, 2]}
)");
  EXPECT_THAT(Message(file), HasSubstr("'trajectory.keys': the camera turns by more than 120 deg between 0 s and 1 s"));
}

TEST(Scenario, ObjectsAreMeshesOnPaths) {
  const SmallWorld world;
  const Scenario scenario = LoadScenario(world.scenario(), {{"world.objects", R"([
    {name: box, file: a/thing.obj, position: [1 cm, 0, 0], orientation: [0, 0.6, 0, 0.8], scale: 2,
     trajectory: {type: scripted, keys: [{time: 0 s, position: [0, 1, 0]}, {time: 0.3 s, position: [1, 1, 0], orientation: [0, 0.6, 0, 0.8]}]}},
    {file: thing.obj, trajectory: {type: rpy, start: {position: [0, 0, 0]}, angles: [0, 1, 0], periods: [1, 1, 1]}}])"}});
  ASSERT_EQ(scenario.world.objects.size(), 2u);
  const ObjectDescription& box = scenario.world.objects[0];
  EXPECT_EQ(box.mesh.name, "box");
  EXPECT_EQ(box.mesh.file, world.folder.path() / "a/thing.obj");
  EXPECT_EQ(box.mesh.position, glm::dvec3(0.01, 0, 0));
  EXPECT_EQ(box.mesh.scale, 2);
  EXPECT_EQ(std::get<ScriptedMotion>(box.motion).keys[1].pose.p_WC, glm::dvec3(1, 1, 0));
  EXPECT_NEAR(std::get<ScriptedMotion>(box.motion).keys[1].pose.q_WC.y, 0.6, 1e-15);
  EXPECT_EQ(scenario.world.objects[1].mesh.name, "thing");
  EXPECT_TRUE(std::holds_alternative<PathMotion>(scenario.world.objects[1].motion));
  EXPECT_THAT(scenario.resolved, HasSubstr("\"objects\""));
  EXPECT_THAT(LoadScenario(world.scenario()).resolved, testing::Not(HasSubstr("objects")));
}

TEST(Scenario, WhatIsWrongWithObjects) {
  const SmallWorld world;
  std::string text = WallScenario();
  text.replace(text.find("  lights:"), 0, R"(  objects:
    - {name: a/b, file: x.obj, trajectory: {type: dolly, start: {position: [0, 0, 0]}, move: [1, 0, 0], period: 1 s}}
    - {file: y.obj, scale: 0, speed: 1, trajectory: {type: scripted, keys: [{time: 0 s, position: [0, 0, 0]}, {time: 0.2 s, position: [1, 0, 0]}]}}
    - {file: z/y.obj}
    - {name: c, trajectory: {type: rolls}}
)");
  const std::string message = Message(world.folder.Write("s.yaml", text));
  for (const char* problem : {
           ":6:14: 'name': an object's name is a file's too: letters, digits, '_' and '-', not 'a/b'",
           ":7:28: 'world.objects.1.scale': '0' must",
           ":7:31: unknown key 'speed'",
           ":7:76: 'trajectory.keys': the last key pose is at 0.2 s, but the scenario lasts 0.3 s",
           ":8:14: 'name': another entry is called 'y' already",
           ": missing key 'world.objects.2.trajectory.type'",
           ": missing key 'world.objects.3.file'",
           ":9:36: 'world.objects.3.trajectory.type': 'rolls' is not known",
       }) {
    EXPECT_THAT(message, HasSubstr(problem));
  }
}

TEST(Scenario, TruthIsDepthByDefault) {
  const SmallWorld world;
  EXPECT_EQ(LoadScenario(world.scenario()).truth.streams, std::set<TruthStream>{TruthStream::depth});
  EXPECT_TRUE(LoadScenario(world.scenario(), {{"truth", "[]"}}).truth.streams.empty());
  try {
    LoadScenario(world.scenario(), {{"truth", "[depth, flows]"}, {"imu.rate", "0 Hz"}, {"landmarks.count", "0"}});
    FAIL();
  } catch (const settings::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'truth': there is no 'flows'; there are depth, depth_exr, "));
    EXPECT_THAT(error.what(), HasSubstr("rate"));
    EXPECT_THAT(error.what(), HasSubstr("count"));
  }
}

TEST(Scenario, OverridesAreChecked) {
  const SmallWorld world;
  EXPECT_EQ(LoadScenario(world.scenario(), {{"seed", "9"}}).seed, 9u);
  EXPECT_EQ(LoadScenario(world.scenario(), {{"odometry.filter.particles", "16"}}).seed, 5u) << "another reader's";
  EXPECT_EQ(Message(world.scenario(), {{"camera.widht", "3"}, {"seed", "-1"}, {"time.duration", "10 ms"}}),
            "--set seed: 'seed': '-1' is not a whole number of at least 0\n"
            "--set time.duration: time.duration = 0.01 s: there is not one frame in it\n"
            "--set camera.widht: unknown key 'widht'; did you mean 'width'?");
}

TEST(Scenario, OldKeyNamesTheNew) {
  const SmallWorld world;
  EXPECT_EQ(Message(world.scenario(), {{"render.bake.finest", "1 cm"}}),
            "--set render.bake.finest: 'render.bake.finest' has a new name: 'min_spacing'");
  const std::string recorded = "{type: recorded, file: f.txt, start: 2 s, average: 0 s, place: {position: [0, 0, 0]}}";
  EXPECT_THAT(Message(world.scenario(), {{"trajectory", recorded}}),
              testing::AllOf(HasSubstr("'start_time'"), HasSubstr("'averaging_time'"), HasSubstr("'start_pose'")));
  EXPECT_THAT(Message(world.scenario(), {{"world", "{points: {landmarks: room, points: 9}}"}}), HasSubstr("'total'"));
}

TEST(LookAt, AxesByHand) {
  const auto axes = [](const glm::dquat& q) {
    return std::array{q * glm::dvec3(1, 0, 0), q * glm::dvec3(0, 1, 0), q * glm::dvec3(0, 0, 1)};
  };
  // Along -z, upright: x to the right is +x, y down is -y.
  const auto ahead = axes(LookAt({0, 1, 0}, {0, 1, -3}, 0));
  EXPECT_LT(glm::length(ahead[0] - glm::dvec3(1, 0, 0)), 1e-15);
  EXPECT_LT(glm::length(ahead[1] - glm::dvec3(0, -1, 0)), 1e-15);
  EXPECT_LT(glm::length(ahead[2] - glm::dvec3(0, 0, -1)), 1e-15);
  // Along +x: right is +z.
  EXPECT_LT(glm::length(axes(LookAt({0, 0, 0}, {2, 0, 0}, 0))[0] - glm::dvec3(0, 0, 1)), 1e-15);
  // Rolled to the right by a quarter turn, the camera's right is the world's down.
  EXPECT_LT(glm::length(axes(LookAt({0, 1, 0}, {0, 1, -3}, std::acos(-1.0) / 2))[0] - glm::dvec3(0, -1, 0)), 1e-15);
  // Straight down and up are not singular.
  EXPECT_LT(glm::length(axes(LookAt({0, 3, 0}, {0, 0, 0}, 0))[1] - glm::dvec3(0, 0, 1)), 1e-15)
      << "the upper edge is towards -z";
  EXPECT_LT(glm::length(axes(LookAt({0, 0, 0}, {0, 3, 0}, 0))[1] - glm::dvec3(0, 0, -1)), 1e-15)
      << "the upper edge is towards +z";
}

// Kolmogorov-Smirnov distance of n numbers to the uniform distribution on [0, 1]: above 1.95 / sqrt(n) with probability
// 0.1 %. The seeds are fixed.
TEST(Scenario, DistributionsAreDrawnBySeedAndKey) {
  const TemporaryFolder folder;
  const auto file = folder.Write("s.yaml", R"(
world: {meshes: [{file: a.obj}]}
camera: {width: 320, height: 240, fx: 260, fy: 261, cx: 159.5, cy: 119.5}
sensor: {white: {uniform: [1, 2]}, quantum_efficiency: {log_uniform: [0.1, 1]}}
time: {rate: 20 Hz, duration: 1 s}
trajectory: {type: sampled, start: {position: [0, 0, 0], look_at: [0, 0, 1]}, position_noise: 0, orientation_noise: 0}
)");
  constexpr int kSeeds = 1000;
  std::vector<double> uniform, logarithmic;
  double product = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scenario s = LoadScenario(file, {{"seed", std::to_string(seed)}});
    uniform.push_back(s.sensor.white - 1);
    logarithmic.push_back((s.sensor.quantum_efficiency - 0.1) / 0.9);
    product += (uniform.back() - 0.5) * (1 + std::log10(s.sensor.quantum_efficiency) - 0.5);
  }
  const auto distance = [](std::vector<double> x) {
    std::ranges::sort(x);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst = std::max({worst, std::abs(x[i] - static_cast<double>(i) / kSeeds),
                        std::abs(x[i] - static_cast<double>(i + 1) / kSeeds)});
    return worst * std::sqrt(kSeeds);
  };
  EXPECT_LT(distance(uniform), 1.95);
  EXPECT_GT(distance(logarithmic), 1.95);                                // the control
  EXPECT_LT(std::abs(product) / kSeeds, 3.29 / 12 / std::sqrt(kSeeds));  // independent: 0.1 %

  const Scenario once = LoadScenario(file), again = LoadScenario(folder.Write("r.yaml", once.resolved));
  EXPECT_EQ(once.sensor.white, again.sensor.white);
  ASSERT_EQ(once.drawn.size(), 2u);
  EXPECT_EQ(once.drawn[0].first, "sensor.white");
  EXPECT_EQ(LoadScenario(file, {{"sensor.exposure", "3 ms"}}).sensor.white, once.sensor.white);
}

}  // namespace
}  // namespace sim
