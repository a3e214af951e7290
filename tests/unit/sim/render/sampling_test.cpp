// Exposure: time samples, antialiasing, determinism.
#include <gmock/gmock.h>

#include <limits>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

// Something with texture, light and shadow in every part of the picture.
Scene BusyWorld() {
  Scene scene;
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 50 * 70 * 3; ++i) rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
  scene.textures.emplace_back("noise", 50, 70, rgb);
  AddMaterial(scene, {0.9f, 0.8f, 0.7f}, glm::vec3(0.0f), 0);
  AddMaterial(scene, {0.3f, 0.8f, 0.4f});
  AddQuad(scene, {-6, -6, 4}, {12, 0, 1}, {0, 12, 1}, 0, 3.0f);
  AddSphere(scene, {0.3, 0.1, 2.2}, 0.5, 20, 1);
  scene.lights = {AmbientLight{{0.1, 0.1, 0.1}}, PointLight{{1, -1, 0}, {9, 8, 7}}, SunLight{{1, 1, 2}, {1, 1, 1}},
                  RectLight{{-1, -1, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {8, 8, 8}}};
  return scene;
}

std::vector<Pose> MovingPoses(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back({{0.02 * i, 0.01 * i, 0.0}, glm::angleAxis(0.004 * i, glm::normalize(glm::dvec3(1, 2, 3)))});
  }
  return poses;
}

RadianceImage Expose(const Renderer& renderer, const std::vector<Pose>& poses, std::uint64_t key,
                     const Camera& camera) {
  RadianceImage image;
  renderer.Expose(camera, poses, key, image);
  return image;
}

TEST(Exposure, SameBytesWithOneAndTwoThreads) {
  const Scene scene = BusyWorld();
  const Camera camera(SmallCamera(131, 97));
  RayTracerOptions one, two, all;
  one.jobs = 1;
  two.jobs = 2;
  all.jobs = 0;
  const auto a = MakeRayTracer(scene, one), b = MakeRayTracer(scene, two), c = MakeRayTracer(scene, all);
  const std::vector<Pose> poses = MovingPoses(4);
  const RadianceImage image = Expose(*a, poses, 7, camera);
  Expose(*b, poses, 8, camera);  // an earlier call leaves nothing behind
  EXPECT_EQ(image.rgb, Expose(*b, poses, 7, camera).rgb);
  EXPECT_EQ(image.rgb, Expose(*c, poses, 7, camera).rgb);
  EXPECT_NE(image.rgb, Expose(*a, poses, 8, camera).rgb);  // the key matters
  std::vector<float> depth_one, depth_two;
  a->Depth(camera, poses[0], depth_one);
  b->Depth(camera, poses[0], depth_two);
  EXPECT_EQ(depth_one, depth_two);
}

TEST(Exposure, IsTheMeanOfItsTimeSamples) {
  Scene scene = BusyWorld();
  scene.lights.pop_back();  // the rectangular light's point depends on the sample's number
  const Camera camera(SmallCamera());
  const auto renderer = MakeRayTracer(scene, Centred());
  const std::vector<Pose> poses = MovingPoses(5);
  const RadianceImage blurred = Expose(*renderer, poses, 1, camera);
  std::vector<double> mean(blurred.rgb.size());
  for (const Pose& pose : poses) {
    const RadianceImage sharp = Expose(*renderer, {pose}, 1, camera);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += sharp.rgb[i] / 5.0;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) ASSERT_NEAR(blurred.rgb[i], mean[i], 1e-6 * (1 + mean[i])) << i;
}

// The edge of a bright half plane crosses each pixel of a row at a known place: what the pixel collects is the bright
// part of its area. n points of the (0, 2)-sequence err by at most 1/n on a vertical edge.
TEST(Exposure, PixelsAreAveragesOverTheirArea) {
  constexpr int n = 64;
  for (const double edge : {10.0, 10.17, 10.5, 10.73}) {
    Scene scene;
    AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
    const CameraParams params = SmallCamera(24, 8);
    const double x = (edge - params.cx) / params.fx;  // on z = 1
    AddQuad(scene, {static_cast<float>(x), -9, 1}, {9, 0, 0}, {0, 18, 0}, 0);
    RayTracerOptions options;
    options.rays_per_time_sample = n;
    const RadianceImage image = Render(scene, Camera(params), Pose{}, options);
    for (int v = 0; v < 8; ++v) {
      for (int u = 0; u < 24; ++u) {
        const double bright = std::clamp(u + 0.5 - edge, 0.0, 1.0);
        ASSERT_NEAR(image.pixel(u, v)[0], bright, 1.0 / n + 1e-5) << "edge " << edge << " at " << u << ", " << v;
      }
    }
  }
}

TEST(Exposure, BackgroundWhereNothingIs) {
  Scene scene;
  scene.background = {0.25f, 0.5f, 1.5f};
  const RadianceImage image = Render(scene, Camera(SmallCamera(9, 5)), Pose{});
  ASSERT_EQ(image.rgb.size(), 9u * 5u * 3u);
  EXPECT_EQ(image.pixel(8, 4)[0], 0.25f);
  EXPECT_EQ(image.pixel(8, 4)[1], 0.5f);
  EXPECT_EQ(image.pixel(8, 4)[2], 1.5f);
}

TEST(Exposure, BadArguments) {
  RadianceImage image;
  EXPECT_THROW(MakeRayTracer(Scene{})->Expose(Camera(SmallCamera()), {}, 1, image), std::invalid_argument);
  RayTracerOptions options;
  options.rays_per_time_sample = 0;
  EXPECT_THROW(MakeRayTracer(Scene{}, options), std::invalid_argument);
  options = {};
  options.jobs = -1;
  EXPECT_THROW(MakeRayTracer(Scene{}, options), std::invalid_argument);

  Scene scene = BusyWorld();
  scene.meshes[1].triangles[3].y = 100000;
  EXPECT_THROW(MakeRayTracer(scene), std::invalid_argument);
  scene = BusyWorld();
  scene.meshes[0].material = 2;
  EXPECT_THROW(MakeRayTracer(scene), std::invalid_argument);
  scene = BusyWorld();
  scene.materials[0].texture = 1;
  EXPECT_THROW(MakeRayTracer(scene), std::invalid_argument);
  scene = BusyWorld();
  scene.meshes[0].uvs.clear();
  EXPECT_THROW(MakeRayTracer(scene), std::invalid_argument);
}

}  // namespace
}  // namespace sim::test
