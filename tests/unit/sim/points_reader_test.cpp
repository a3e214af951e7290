#include <gmock/gmock.h>

#include <string>

#include "sim/points/point_world.h"
#include "sim/scenario/scenario.h"
#include "sim/simulator.h"
#include "tests/unit/sim/temporary_folder.h"
#include "tools/base/settings/problem.h"

namespace sim {
namespace {

using testing::HasSubstr;

std::string Text(const std::string& world, const std::string& more = "") {
  return "world: " + world + "\n" + more +
         "camera: {width: 640, height: 480, fx: 525, fy: 525, cx: 319.5, cy: 239.5}\n"
         "time: {rate: 30 Hz, duration: 1 s}\n"
         "trajectory: {type: sampled, start: {position: [0, 0, 0]}, position_noise: 1, orientation_noise: 1}\n";
}

Scenario Read(const std::string& text) {
  const TemporaryFolder folder;
  return LoadScenario(folder.Write("p.yaml", text));
}

std::string Complaint(const std::string& text) {
  const TemporaryFolder folder;
  try {
    LoadScenario(folder.Write("p.yaml", text));
  } catch (const settings::Error& error) {
    const std::string message = error.what(), where = (folder.path() / "p.yaml").string();
    return message.starts_with(where) ? message.substr(where.size()) : message;
  }
  return "accepted";
}

TEST(PointsReader, EveryKeyIsRead) {
  const PointDescription prior =
      *Read(Text(R"({points: {landmarks: prior, count: 50, forget_after: 7, inverse_depth: 0.5,
    inverse_depth_sigma: 0.1, scale_sigma: 0.4, margin: 3 px, measurement: {noise: 2 px, drops: 0.1, outliers: {probability: 0.2, radius: 30 px},
    blur: {length: 9 px, exposure: 20 ms}}}})"))
           .points;
  EXPECT_EQ(prior.landmarks, Landmarks::prior);
  EXPECT_EQ(prior.count, 50);
  EXPECT_EQ(prior.forget_after, 7);
  EXPECT_EQ(prior.inverse_depth, 0.5);
  EXPECT_EQ(prior.inverse_depth_sigma, 0.1);
  EXPECT_EQ(prior.scale_sigma, 0.4);
  EXPECT_EQ(prior.margin_px, 3);
  EXPECT_EQ(prior.measurement.noise_px, 2);
  EXPECT_EQ(prior.measurement.drop_probability, 0.1);
  EXPECT_EQ(prior.measurement.outlier_probability, 0.2);
  EXPECT_EQ(prior.measurement.outlier_radius_px, 30);
  EXPECT_EQ(prior.measurement.blur_length_px, 9);
  EXPECT_EQ(prior.measurement.blur_exposure_s, 0.02);
  const PointDescription room =
      *Read(Text("{points: {landmarks: room, total: 10, size: 4 m, center: [1, 2, 3], min_depth: 20 cm}}")).points;
  EXPECT_EQ(room.landmarks, Landmarks::room);
  EXPECT_EQ(room.total, 10);
  EXPECT_EQ(room.size_m, 4);
  EXPECT_EQ(*room.center, glm::dvec3(1, 2, 3));
  EXPECT_EQ(room.min_depth_m, 0.2);
  const PointDescription plane = *Read(Text("{points: {landmarks: plane, distance: 2 m}}")).points;
  EXPECT_EQ(plane.distance_m, 2);
  EXPECT_FALSE(plane.center);
  EXPECT_EQ(Read(Text("{points: {landmarks: cloud}}")).points->landmarks, Landmarks::cloud);
}

TEST(PointsReader, WhatItResolvesToIsTheSameWorld) {
  for (const std::string kind : {"prior", "room", "plane", "cloud, center: [0, 1, 0]"}) {
    const Scenario scenario = Read(Text("{points: {landmarks: " + kind + "}}"));
    const Scenario again = Read(scenario.resolved);
    EXPECT_EQ(again.resolved, scenario.resolved);
    PointWorld a(scenario), b(again);
    EXPECT_EQ(a.Next()->observations.back().x_px, b.Next()->observations.back().x_px);
  }
}

TEST(PointsReader, OneErrorForEachThingThatIsWrong) {
  EXPECT_EQ(Complaint(Text("{points: {landmarks: prior, count: 0}}")),
            ":1:43: 'world.points.count': '0' must lie in 1 ... 1000000");
  EXPECT_EQ(Complaint(Text("{points: {landmarks: prior, measurement: {drops: 1.5}}}")),
            ":1:57: 'world.points.measurement.drops': '1.5' must lie in 0 ... 1");
  EXPECT_EQ(Complaint(Text("{points: {landmarks: prior, margin: 240 px}}")),
            ":1:44: world.points.margin = 240 px must leave something of the image");
  EXPECT_THAT(Complaint(Text("{points: {landmarks: prior, size: 5 m}}")), HasSubstr(":1:36: unknown key 'size'"));
  EXPECT_THAT(Complaint(Text("{points: {landmarks: prior, noize: 1 px}}")), HasSubstr("unknown key 'noize'"));
  EXPECT_THAT(Complaint(Text("{points: {landmarks: ruum, size: 3}}")),
              HasSubstr("'ruum' is not known; did you mean 'room'?"));
  EXPECT_THAT(Complaint(Text("{points: {count: 3}}")), HasSubstr("missing key 'world.points.landmarks'"));
  EXPECT_EQ(
      Complaint(Text("{points: {landmarks: prior}, meshes: [{file: a.obj}]}")),
      ":1:45: 'world.meshes' is for worlds that are rendered: it goes with 'world.meshes', not with 'world.points'");
  EXPECT_THAT(Complaint(Text("{points: {landmarks: prior}}", "sensor: {exposure: 3 ms}\n")),
              HasSubstr(":2:9: 'sensor' is for worlds that are rendered"));
  for (const char* line :
       {"render: {reflections: true}", "truth: [depth]", "landmarks: {count: 5}", "imu: {rate: 9 Hz}"}) {
    const std::string key = std::string(line).substr(0, std::string(line).find(':'));
    EXPECT_THAT(Complaint(Text("{points: {landmarks: prior}}", std::string(line) + "\n")),
                HasSubstr("'" + key + "' is for worlds that are rendered"));
  }
  EXPECT_THAT(Complaint(Text("{}")), HasSubstr("the world is empty"));
}

TEST(PointsReader, APointWorldIsNotRendered) {
  const Scenario scenario = Read(Text("{points: {landmarks: prior}}"));
  try {
    Simulator simulator(scenario, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "p: a world of points has no images; `vobench run` plays it");
  }
}

}  // namespace
}  // namespace sim
