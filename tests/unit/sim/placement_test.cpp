// Paths in a room of 8 x 3 x 8 m with a pillar, with distances to surfaces in closed form.
#include "sim/motion/placement.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "sim/motion/path.h"
#include "sim/render/scene_surroundings.h"
#include "sim/simulator.h"
#include "tests/unit/sim/temporary_folder.h"

namespace sim {
namespace {

using testing::HasSubstr;

struct Box {
  glm::dvec3 low, high;
};
const Box kRoom{{0, 0, 0}, {8, 3, 8}}, kPillar{{3.5, 0, 3.5}, {4.5, 3, 4.5}};

// Closed form inside the room and outside the pillar.
double DistanceToSurface(const glm::dvec3& p) {
  const glm::dvec3 in = glm::min(p - kRoom.low, kRoom.high - p);
  const glm::dvec3 out = glm::max(glm::max(kPillar.low - p, p - kPillar.high), glm::dvec3(0));
  return std::min({in.x, in.y, in.z, glm::length(out)});
}

std::string BoxPly(const Box& box) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 6\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) text += std::to_string(((i >> axis) & 1 ? box.high : box.low)[axis]) + " ";
    text += std::to_string(30 * i + 10) + " 100 " + std::to_string(250 - 30 * i) + "\n";
  }
  return text + "4 0 1 3 2\n4 4 5 7 6\n4 0 1 5 4\n4 2 3 7 6\n4 0 2 6 4\n4 1 3 7 5\n";
}

class Room : public testing::Test {
 protected:
  Room() {
    folder_.Write("room.ply", BoxPly(kRoom));
    folder_.Write("pillar.ply", BoxPly(kPillar));
  }
  Scenario Load(const std::string& trajectory, double duration_s, const std::string& more = "") {
    return LoadScenario(folder_.Write("s.yaml",
                                      "world:\n  meshes: [{file: room.ply}, {file: pillar.ply}]\n"
                                      "  lights: [{type: ambient, radiance: [1, 1, 1]}]\n"
                                      "camera: {width: 32, height: 24, fx: 26, fy: 26, cx: 15.5, cy: 11.5}\n"
                                      "time: {rate: 30 Hz, duration: " +
                                          std::to_string(duration_s) + " s}\n" + more + "trajectory: " + trajectory +
                                          "\n"));
  }
  std::string Refusal(const Scenario& scenario) {
    try {
      Simulator(scenario, 1);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "none";
  }
  TemporaryFolder folder_;
};

TEST_F(Room, DistancesAndWaysAreThoseOfTheBoxes) {
  const Scenario scenario = Load("{type: handheld}", 1);
  const Scene scene = LoadScene(scenario.world);
  const RayScene rays(scene);
  const auto surroundings = SurroundingsOf(scene, rays);
  const Surroundings& around = *surroundings;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 p = glm::dvec3(share(random), share(random), share(random)) * kRoom.high;
    if (glm::all(glm::greaterThan(p, kPillar.low)) && glm::all(glm::lessThan(p, kPillar.high))) continue;
    const double distance = DistanceToSurface(p);
    const auto nearest = around.Nearest(p, 5);
    ASSERT_TRUE(nearest);
    EXPECT_NEAR(glm::distance(p, *nearest), distance, 1e-6);
    EXPECT_FALSE(around.Nearest(p, 0.99 * distance - 1e-6));
  }
  const auto hit = around.Between({1, 1, 4}, {7, 1, 4});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->point.x, 3.5, 1e-5);
  EXPECT_THAT(hit->mesh, HasSubstr("mesh 1"));
  EXPECT_FALSE(around.Between({1, 1, 4}, {3.4, 1, 4}));
  EXPECT_FALSE(around.Between({1, 1, 1}, {7, 1, 1}));
}

TEST_F(Room, InterestIsWhereAlbedosDiffer) {
  const Scenario scenario = Load("{type: handheld}", 1);
  const Scene scene = LoadScene(scenario.world);
  const RayScene rays(scene);
  const auto around = SurroundingsOf(scene, rays);
  EXPECT_GT(around->Interest({{1, 1.5, 4}, glm::dquat(std::sqrt(0.5), 0, std::sqrt(0.5), 0)}), 0.01) << "the pillar";
  EXPECT_EQ(around->Interest({{4, 1.5, 20}, glm::dquat(1, 0, 0, 0)}), 0) << "away from everything";
}

// The share of instants at which a point in a corner is within 45 degrees of the camera's axis.
double ShareTowardsCorner(const Trajectory& path) {
  int seen = 0;
  for (int k = 0; k < 590; ++k) {
    const Pose pose = path.At(0.1 * k).pose;
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.1, 1.5, 0.1) - pose.p_WC);
    seen += glm::dot(way, pose.q_WC * glm::dvec3(0, 0, 1)) > std::sqrt(0.5);
  }
  return seen / 590.0;
}

TEST_F(Room, LooksWhereItIsTold) {
  const std::string type = "{type: handheld, start: {position: [6, 1.5, 6], look_at: [0.1, 1.5, 0.1]}";
  EXPECT_GT(ShareTowardsCorner(*TrajectoryOf(Load(type + ", look_at: [0.1, 1.5, 0.1]}", 60))), 0.9);
  EXPECT_LT(ShareTowardsCorner(*TrajectoryOf(Load(type + ", look_at: [8, 1.5, 8]}", 60))), 0.5);
}

TEST_F(Room, CarriedCamerasKeepTheirClearance) {
  std::mt19937_64 random(2);
  for (const std::string type : {"handheld, speed: 0.4 m/s, clearance: 0.3 m", "drone, clearance: 0.4 m"}) {
    for (const char* seed : {"1", "2", "3"}) {
      const Scenario scenario = Load("{type: " + type + ", seed: " + seed + "}", 60);
      const auto path = TrajectoryOf(scenario);
      const double clearance = std::get<RoamingMotion>(scenario.motion).clearance;
      double nearest = 1e9, longest = 0;
      std::uniform_real_distribution<double> time(0, 60 - 1.0 / 30);
      for (int i = 0; i < 10000; ++i) {
        const Motion at = path->At(time(random));
        nearest = std::min(nearest, DistanceToSurface(at.pose.p_WC));
        longest = std::max(longest, glm::distance(at.pose.p_WC, path->At(0).pose.p_WC));
      }
      EXPECT_GE(nearest, clearance) << type << " " << seed;
      EXPECT_GT(longest, 0.5) << type << " " << seed;
      EXPECT_EQ(Refusal(scenario), "none");
    }
  }
  EXPECT_THAT(Refusal(Load("{type: handheld, clearance: 1.49 m, start: {position: [2, 1.5, 2]}}", 20)),
              HasSubstr("keeps the clearance of 1.49 m"));
}

// A straight line of 4 m at constant speed between two keys, which meets the pillar after 1 m.
TEST_F(Room, AWallThatIsPassedThroughIsNamedWithItsTime) {
  const auto through = [](const std::string& z) {
    return "{type: scripted, keys: [{time: 0 s, position: [2.5, 1, " + z + "]}, {time: 2 s, position: [6.5, 1, " + z +
           "]}]}";
  };
  const std::string refusal = Refusal(Load(through("4"), 2));
  EXPECT_THAT(refusal, HasSubstr("passes through a surface of 'mesh 1'"));
  EXPECT_THAT(refusal, HasSubstr("at 0.5 s, at (3.5, 1, 4) m"));
  EXPECT_EQ(Refusal(Load(through("3.4"), 2)), "none");
  EXPECT_EQ(Refusal(Load(through("4"), 2, "sensor: {covered: [{from: 0.4 s, until: 1.1 s}]}\n")), "none");
}

TEST_F(Room, ARecordedPathIsPlacedWhereItIsFree) {
  std::string rows;  // z up, at the origin, looking along y
  for (int k = 0; k <= 40; ++k)
    rows += std::to_string(0.1 * k) + " " + std::to_string(0.05 * k) + " 0 " + std::to_string(0.2 * std::sin(0.3 * k)) +
            " -0.7071068 0 0 0.7071068\n";
  folder_.Write("path.txt", rows);
  EXPECT_THAT(Refusal(Load("{type: recorded, file: path.txt}", 3)), HasSubstr("passes through a surface"));
  const Scenario scenario = Load("{type: recorded, file: path.txt, placing: auto, clearance: 0.3 m}", 3);
  EXPECT_EQ(Refusal(scenario), "none");
  const auto path = TrajectoryOf(scenario);
  for (int k = 0; k < 300; ++k) {
    const Pose pose = path->At(0.01 * k * 2.9 / 3).pose;
    EXPECT_GT(DistanceToSurface(pose.p_WC), 0.28);
    EXPECT_NEAR((pose.q_WC * glm::dvec3(0, -1, 0)).y, 1, 1e-6) << "upright";
  }
  EXPECT_NEAR(glm::distance(path->At(0).pose.p_WC, path->At(2).pose.p_WC), std::hypot(1, 0.2 * std::sin(6.0)), 0.01)
      << "its shape stays";
  EXPECT_THAT(Refusal(Load("{type: recorded, file: path.txt, placing: auto, clearance: 2 m}", 3)),
              HasSubstr("no place and heading keeps the path"));
}

TEST(Revisits, AreThoseOfAnOrbit) {
  PathMotion orbit;
  orbit.start.p_WC = {2, 0, 0};
  orbit.azimuth = {Swing::Kind::steady, 6.283185307179586, 10};
  const std::vector<Revisit> revisits = Revisits(PathTrajectory(orbit), 21);
  ASSERT_EQ(revisits.size(), 1u) << "all of the second round";
  EXPECT_NEAR(revisits[0].t_s, 10, 0.51);
  EXPECT_NEAR(revisits[0].t_s - revisits[0].earlier_s, 10, 0.51);
  EXPECT_TRUE(Revisits(PathTrajectory(orbit), 9).empty());
}

}  // namespace
}  // namespace sim
