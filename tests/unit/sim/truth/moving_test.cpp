// Ground truth of moving objects: closed forms, and the files.
#include <gmock/gmock.h>

#include <glm/geometric.hpp>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "sim/render/surface_tracer.h"
#include "sim/sequence/flow.h"
#include "sim/sequence/landmarks.h"
#include "sim/sequence/layout.h"
#include "sim/sequence/streams.h"
#include "tests/unit/sim/render/moving_worlds.h"
#include "tests/unit/sim/small_world.h"

namespace sim {
namespace {

using testing::HasSubstr;

// f v dt / Z: flow of a square of 1 m that moves at Z = 2 in front of a wall at Z = 4; the camera is at rest.
TEST(MovingTruth, FlowOfASquareIsItsVelocity) {
  const glm::dvec3 v(0.9, -0.6, 0.0);
  constexpr double kStep = 1.0 / 30, t_s = 0.2;
  Scene scene;
  test::AddMaterial(scene, glm::vec3(1.0f));
  test::AddQuad(scene, {-8, -8, 4}, {16, 0, 0}, {0, 16, 0}, 0);
  test::AddQuad(scene, {-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, 0);
  test::MakeObject(scene, 1, std::make_shared<test::SteadyMotion>(Pose{}, v));
  const Camera camera(test::SmallCamera());
  const auto renderer = MakeRayTracer(scene);
  std::vector<SurfacePoint> points;
  renderer->surfaces()->Trace(camera, View({}, t_s), points);
  for (const double step : {kStep, -kStep}) {
    const FlowImage flow = FlowBetween(*renderer->surfaces(), camera, points, View({}, t_s), View({}, t_s + step));
    const FlowImage stopped = FlowBetween(*renderer->surfaces(), camera, points, View({}, t_s), View({}, t_s));
    int on_square = 0, hidden = 0;
    for (int y = 0; y < camera.height(); ++y) {
      for (int x = 0; x < camera.width(); ++x) {
        const auto i = static_cast<std::size_t>(y * camera.width() + x);
        const glm::dvec2 ray((x - 41.0) / 70, (y - 30.0) / 70), now = 2.0 * ray - t_s * glm::dvec2(v),
                                                                then = 2.0 * ray - (t_s + step) * glm::dvec2(v);
        const auto inside = [](const glm::dvec2& p) { return std::max(std::abs(p.x), std::abs(p.y)) - 0.5; };
        if (std::abs(inside(now)) < 1e-6 || std::abs(inside(then)) < 1e-6) continue;
        const bool square = inside(now) < 0;
        ASSERT_EQ(points[i].object, square ? 0 : kWorld) << x << ", " << y;
        ASSERT_NEAR(points[i].depth, square ? 2 : 4, 1e-9);
        const glm::dvec2 expected = square ? 70.0 / 2 * step * glm::dvec2(v) : glm::dvec2(0.0);
        ASSERT_NEAR(flow.uv[2 * i], expected.x, 3e-6) << x << ", " << y;
        ASSERT_NEAR(flow.uv[2 * i + 1], expected.y, 3e-6) << x << ", " << y;
        ASSERT_NEAR(stopped.uv[2 * i], 0, 3e-6) << "the control";
        const bool behind = !square && inside(then) < 0;
        const double u = x + expected.x, w = y + expected.y;
        const bool in_image = u >= -0.5 && w >= -0.5 && u <= 82.5 && w <= 60.5;
        ASSERT_EQ(flow.occluded[i], behind || !in_image) << x << ", " << y;
        on_square += square;
        hidden += behind;
      }
    }
    EXPECT_GT(on_square, 1000);
    EXPECT_GT(hidden, 25);
  }
}

// Exchange of object and camera motion: a moving object and a camera at rest against a static world and a camera with
// the relative motion.
TEST(MovingTruth, ObjectAndCameraChangePlaces) {
  Scene still;
  test::AddMaterial(still, glm::vec3(1.0f));
  test::AddQuad(still, {-6, -6, 4}, {12, 0, 1}, {0, 12, 1}, 0);
  test::AddBox(still, {-0.7f, -0.5f, 1.9f}, {0.2f, 0.3f, 2.9f}, 0);
  Scene moving = still;
  test::MakeObject(moving, 0, test::Carried());
  const Pose camera_pose = test::TiltedPose();
  const test::SeenFrom relative(test::Carried(), camera_pose);
  const Camera camera(test::DistortedCamera());
  const auto a = MakeRayTracer(moving), b = MakeRayTracer(still);
  const double t_s = 0.1, next_s = 0.15;
  std::vector<SurfacePoint> points, same;
  a->surfaces()->Trace(camera, View(camera_pose, t_s), points);
  b->surfaces()->Trace(camera, relative.At(t_s).pose, same);
  const FlowImage flow = FlowBetween(*a->surfaces(), camera, points, View(camera_pose, t_s), View(camera_pose, next_s));
  const FlowImage other = FlowBetween(*b->surfaces(), camera, same, relative.At(t_s).pose, relative.At(next_s).pose);
  int edges = 0, hidden = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle != same[i].triangle) {
      ++edges;
      continue;
    }
    if (points[i].triangle == kNoTriangle) continue;
    ASSERT_NEAR(points[i].depth, same[i].depth, 1e-9);
    for (std::size_t c = 0; c < 2; ++c)
      ASSERT_NEAR(flow.uv[2 * i + c], other.uv[2 * i + c], 2e-6 + 1e-6 * std::abs(other.uv[2 * i + c]));
    edges += flow.occluded[i] != other.occluded[i];
    hidden += flow.occluded[i];
    const glm::dvec3 n = a->surfaces()->ObjectPoses(t_s)[0].q_WC * a->surfaces()->Normal(points[i].triangle);
    ASSERT_NEAR(
        glm::dot(glm::normalize(glm::conjugate(camera_pose.q_WC) * n),
                 glm::normalize(glm::conjugate(relative.At(t_s).pose.q_WC) * b->surfaces()->Normal(same[i].triangle))),
        1, 1e-12);
  }
  EXPECT_LE(edges, 4);
  EXPECT_GT(hidden, 100);
}

// A board of 1 m x 0.75 m at z = -1, in front of SmallWorld's wall, on a trajectory of its own.
Scenario WithBoard(const SmallWorld& world, const std::string& trajectory) {
  return LoadScenario(
      world.scenario(),
      {{"world.objects",
        "[{name: board, file: wall.ply, scale: 0.25, position: [0, 0, -0.5], trajectory: " + trajectory + "}]"},
       {"trajectory",
        "{type: dolly, start: {position: [0, 0, 0], look_at: [0, 0, -2]}, move: [0, 0, 1 mm], period: 9 s}"}});
}
constexpr char kDolly[] = "{type: dolly, start: {position: [-0.2, 0.1, 0]}, move: [0.6, 0, 0], period: 0.6 s}";

TEST(MovingTruth, StreamsOfABoard) {
  const SmallWorld world;
  const Simulator simulator(WithBoard(world, kDolly), 1), parallel(WithBoard(world, kDolly), 2);
  ASSERT_EQ(simulator.object_names(), std::vector<std::string>{"board"});
  ASSERT_EQ(simulator.mesh_names().size(), 2u);
  EXPECT_THAT(simulator.mesh_names()[1], testing::StartsWith("board/"));
  std::map<std::string, std::vector<std::uint8_t>> files;
  for (const StreamFile& file : FrameStreams(simulator, 4, {TruthStream::moving, TruthStream::surface_id}))
    files[file.path] = file.bytes;
  for (const StreamFile& file : SequenceStreams(simulator, 0, 9, {TruthStream::moving})) files[file.path] = file.bytes;
  const cv::Mat mask = cv::imdecode(files.at("moving/0.133333333.png"), cv::IMREAD_UNCHANGED),
                ids = cv::imdecode(files.at("surface_id/0.133333333.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(mask.type(), CV_8UC1);
  const Truth truth = simulator.TruthAt(4), board = simulator.ObjectTruthAt(0, 4);
  EXPECT_NEAR(
      board.p_WC.x,
      -0.2 + 0.3 * (1 - std::cos(2 * 3.14159265358979 * static_cast<double>(simulator.StampNs(4)) * 1e-9 / 0.6)),
      1e-12);
  int seen = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const glm::dvec3 ray = truth.q_WC * glm::dvec3((x - 31.5) / 52, (y - 23.5) / 52, 1);
      const glm::dvec3 X_O = truth.p_WC + (-1 - truth.p_WC.z) / ray.z * ray - board.p_WC;
      if (std::abs(std::abs(X_O.x) - 0.5) < 1e-5 || std::abs(std::abs(X_O.y) - 0.375) < 1e-5) continue;
      const bool moving = std::abs(X_O.x) < 0.5 && std::abs(X_O.y) < 0.375;
      ASSERT_EQ(mask.at<std::uint8_t>(y, x), moving ? 255 : 0) << x << ", " << y;
      ASSERT_EQ(ids.at<std::uint16_t>(y, x) == 2, moving) << x << ", " << y;
      seen += moving;
    }
  }
  EXPECT_GT(seen, 1000);
  std::string poses = "# timestamp tx ty tz qx qy qz qw\n";
  for (int k = 0; k < 9; ++k) poses += TruthLine(simulator.StampNs(k), simulator.ObjectTruthAt(0, k));
  EXPECT_EQ(std::string(files.at("objects/board.txt").begin(), files.at("objects/board.txt").end()), poses);
  EXPECT_TRUE(StreamNames().contains("objects"));
  EXPECT_EQ(simulator.Render(4).image.data, parallel.Render(4).image.data);
  EXPECT_NE(simulator.Render(4).image.data, simulator.Render(5).image.data);
}

// Landmarks: on static surfaces alone, and occluded by the objects in front of them.
TEST(MovingTruth, LandmarksStandStill) {
  const SmallWorld world;
  const Simulator simulator(WithBoard(world, kDolly), 1);
  const auto landmarks = SpreadLandmarks(simulator, 60);
  EXPECT_GT(landmarks.size(), 40u);
  for (const SurfaceLandmark& landmark : landmarks) EXPECT_NEAR(landmark.X_W.z, -2, 1e-12);
  int changes = 0;
  std::map<std::uint32_t, bool> last;
  for (std::int64_t k = 0; k < 9; ++k) {
    const Truth truth = simulator.TruthAt(k), board = simulator.ObjectTruthAt(0, k);
    for (const LandmarkView& view : ViewsOf(simulator, landmarks, k)) {
      const glm::dvec3 ray = landmarks[view.id].X_W - truth.p_WC;
      const glm::dvec3 X_O = truth.p_WC + (-1 - truth.p_WC.z) / ray.z * ray - board.p_WC;
      const bool hidden = std::abs(X_O.x) < 0.5 && std::abs(X_O.y) < 0.375;
      EXPECT_EQ(view.visible, !hidden) << k << ", " << view.id;
      changes += last.contains(view.id) && last[view.id] != view.visible;
      last[view.id] = view.visible;
    }
  }
  EXPECT_GT(changes, 5);
}

// Sampled motions: different for each object and for the camera.
TEST(MovingTruth, SampledObjectsDiffer) {
  const SmallWorld world;
  constexpr char kSampled[] =
      "{type: sampled, start: {position: [0, 0, 0]}, position_noise: 0.5, orientation_noise: 0.5}";
  const std::string one = std::string("name: a, file: wall.ply, trajectory: ") + kSampled,
                    two = std::string("name: b, file: wall.ply, trajectory: ") + kSampled;
  const Simulator simulator(
      LoadScenario(world.scenario(), {{"world.objects", "[{" + one + "}, {" + two + "}]"}, {"trajectory", kSampled}}),
      1);
  const glm::dvec3 a = simulator.ObjectTruthAt(0, 8).p_WC, b = simulator.ObjectTruthAt(1, 8).p_WC,
                   c = simulator.TruthAt(8).p_WC;
  EXPECT_GT(glm::length(a - b), 1e-3);
  EXPECT_GT(glm::length(a - c), 1e-3);
  EXPECT_GT(glm::length(b - c), 1e-3);
}

}  // namespace
}  // namespace sim
