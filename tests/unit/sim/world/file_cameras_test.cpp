// Cameras of glTF files in scenarios: poses and focal lengths worked by hand, and refusals.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "sim/motion/trajectory.h"
#include "sim/scenario/scenario.h"
#include "sim/simulator.h"
#include "tests/unit/sim/world/files.h"
#include "tools/base/settings/settings.h"

namespace sim::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

// The triangle of a file that has five cameras: "door" lies below an invisible node that is moved to (1, 2, 3), turned
// by 90 degrees about y (x to -z, z to x) and twice as large, 0.5 along its z: at (2, 2, 3) of the file, looking along
// -x.
// yfov: 2 atan(0.5) = 0.9272952180016122.
constexpr const char* kFile = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 4, 5, 6]}],
  "nodes": [{"mesh": 0},
    {"translation": [1, 2, 3], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "scale": [2, 2, 2],
     "children": [2, 3], "extensions": {"KHR_node_visibility": {"visible": false}}},
    {"name": "door", "camera": 0, "translation": [0, 0, 0.5]},
    {"camera": 1, "matrix": [-1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  0, 0, 0, 1]},
    {"name": "top", "camera": 2, "translation": [5, 5, 3]}, {"name": "twice", "camera": 0}, {"name": "twice", "camera": 0}],
  "cameras": [
    {"name": "lens", "type": "perspective", "perspective": {"yfov": 0.9272952180016122, "aspectRatio": 1.5, "znear": 0.1}},
    {"name": "own", "type": "perspective", "perspective": {"yfov": 0.9272952180016122, "znear": 0.1}},
    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]%})";

struct Parts {
  std::string start = "{camera: door}", camera = "{from: door, width: 600}", mesh = "{file: hall.gltf}";
  std::string more{};  // at the end of the glTF file
};

Scenario Load(const Folder& folder, const Parts& parts) {
  std::string file = kFile;
  file.replace(file.find('%'), 1, parts.more);
  folder.Write("hall.gltf", file);
  return LoadScenario(folder.Write("s.yaml", "world: {meshes: [" + parts.mesh +
                                                 "], lights: []}\ncamera: " + parts.camera +
                                                 "\ntime: {duration: 1 s}\ntrajectory: {type: dolly, "
                                                 "move: [0, 0, 0], period: 1 s, start: " +
                                                 parts.start + "}\n"));
}

std::string Problem(const Parts& parts) {
  const Folder folder;
  try {
    Load(folder, parts);
  } catch (const settings::Error& error) {
    return error.what();
  }
  return "";
}

Pose PoseOf(const Parts& parts) {
  const Folder folder;
  return std::get<PathMotion>(Load(folder, parts).motion).start;
}

void ExpectPose(const Pose& pose, const glm::dvec3& position, const glm::dvec3& right, const glm::dvec3& forward) {
  EXPECT_LT(glm::distance(pose.p_WC, position), 1e-12);
  EXPECT_LT(glm::distance(pose.q_WC * glm::dvec3(1, 0, 0), right), 1e-12);
  EXPECT_LT(glm::distance(pose.q_WC * glm::dvec3(0, 0, 1), forward), 1e-12);
}

TEST(FileCameras, PlaceIsThatOfTheNode) {
  ExpectPose(PoseOf({}), {2, 2, 3}, {0, 0, -1}, {-1, 0, 0});
  // Pose of the mesh in the world: a turn of 90 degrees about x (y to z), scale 3, a shift along x.
  const Parts moved{.mesh =
                        "{file: hall.gltf, position: [10, 0, 0], scale: 3, "
                        "orientation: [0.7071067811865476, 0, 0, 0.7071067811865476]}"};
  ExpectPose(PoseOf(moved), {16, -9, 6}, {0, 1, 0}, {-1, 0, 0});
}

// Scale of the nodes is ignored, with that of a mirror: up and ahead keep their directions.
TEST(FileCameras, CameraBelowAMirrorIsStillUpright) {
  ExpectPose(PoseOf({.start = "{camera: own}"}), {1, 2, 3}, {0, 0, -1}, {-1, 0, 0});
}

TEST(FileCameras, FocalLengthsAreThoseOfTheAngles) {
  const Folder folder;
  const CameraParams wide = Load(folder, {}).camera;  // 600 / 1.5 rows; half of them over tan(yfov / 2) = 0.5
  EXPECT_EQ(wide.width, 600);
  EXPECT_EQ(wide.height, 400);
  EXPECT_NEAR(wide.fx, 400, 1e-9);
  EXPECT_NEAR(wide.fy, 400, 1e-9);
  EXPECT_EQ(wide.cx, 299.5);
  EXPECT_EQ(wide.cy, 199.5);
  const CameraParams both = Load(folder, {.camera = "{from: hall/door, width: 600, height: 400}"}).camera;
  EXPECT_EQ(both.fy, wide.fy);
  // 601 / 1.5 = 400.67 rows are 401: pixels are not quite square.
  const CameraParams odd = Load(folder, {.camera = "{from: door, width: 601, distortion: {k1: 0.1}}"}).camera;
  EXPECT_NEAR(odd.fx, 601 / 1.5, 1e-9);
  EXPECT_NEAR(odd.fy, 401, 1e-9);
  EXPECT_EQ(odd.k1, 0.1);
  const CameraParams free = Load(folder, {.camera = "{from: own, width: 640, height: 480, cx: 300}"}).camera;
  EXPECT_NEAR(free.fx, 480, 1e-9);
  EXPECT_EQ(free.cx, 300) << "what is written beside it counts";
}

TEST(FileCameras, ResolvedScenarioIsTheSame) {
  const Folder folder;
  const Scenario scenario = Load(folder, {});
  const Scenario again = LoadScenario(folder.Write("again.yaml", scenario.resolved));
  EXPECT_EQ(again.resolved, scenario.resolved);
  EXPECT_EQ(again.camera.fy, scenario.camera.fy);
  EXPECT_EQ(std::get<PathMotion>(again.motion).start.p_WC, std::get<PathMotion>(scenario.motion).start.p_WC);
}

TEST(FileCameras, ScriptLeadsFromOneToTheNext) {
  const Folder folder;
  Load(folder, {});
  const Scenario scenario = LoadScenario(
      folder.Write("s.yaml",
                   "world: {meshes: [{file: hall.gltf}], lights: []}\ncamera: {from: door, width: 60}\n"
                   "trajectory: {type: scripted, keys: [{time: 0 s, camera: top}, {time: 1 s, camera: door}]}"));
  const Simulator simulator(scenario, 1);
  ExpectPose(simulator.trajectory().At(1).pose, {2, 2, 3}, {0, 0, -1}, {-1, 0, 0});
}

TEST(FileCameras, WrongNameListsThoseThatAre) {
  const std::string problem = Problem({.start = "{camera: dor}"});
  EXPECT_THAT(problem,
              AllOf(HasSubstr("s.yaml:4:"), HasSubstr("'camera': there is no camera 'dor'; there are hall/door, "
                                                      "hall/own, hall/top, hall/twice, hall/twice")));
  EXPECT_THAT(Problem({.camera = "{from: dor, width: 60}"}), HasSubstr("'from': there is no camera 'dor'; there are"));
  EXPECT_THAT(Problem({.start = "{camera: twice}"}), HasSubstr("there is more than one camera 'twice'"));
  EXPECT_THAT(Problem({.start = "{camera: door, look_at: [0, 0, 0]}"}),
              HasSubstr("'camera' and 'look_at' exclude each other"));
  const Folder folder;
  folder.Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  try {
    Load(folder, {.mesh = "{file: flat.obj}"});
    FAIL();
  } catch (const settings::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("there are none in glTF files of 'world.meshes'"));
  }
}

TEST(FileCameras, IntrinsicsThatCannotBeAreRefused) {
  EXPECT_THAT(Problem({.camera = "{from: top, width: 600}"}),
              HasSubstr("hall/top is orthographic, which is not rendered"));
  EXPECT_THAT(Problem({.camera = "{from: door, width: 640, height: 480}"}),
              HasSubstr("has 427 rows for a width of 640"));
  EXPECT_THAT(Problem({.camera = "{from: own, width: 640}"}), HasSubstr("'height' is missing"));
  EXPECT_THAT(Problem({.camera = "{from: door}"}), HasSubstr("missing key 'camera.width'"));
}

TEST(FileCameras, AnimationIsSaid) {
  const Folder folder;
  const Scenario scenario = Load(folder, {.more = R"(, "animations": [{"channels": [], "samplers": []}])"});
  EXPECT_THAT(LoadScene(scenario.world).warnings, Contains(HasSubstr("has animations")));
}

}  // namespace
}  // namespace sim::test
