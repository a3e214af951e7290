// Baked light in rendered images.
#include <gmock/gmock.h>

#include <string>

#include "sim/render/sample_pattern.h"
#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

BakeParams Every(double spacing_m = 0.2, double min_spacing_m = 0.02, int paths = 256) {
  return {spacing_m, min_spacing_m, paths};
}

// Linear interpolation on the lattice: light that is linear in position, on both sides, at several resolutions, by
// every kernel.
TEST(BakedPicture, LatticeIsInterpolatedLinearly) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-3, -3, 2}, {6, 0, 0}, {0, 6, 0}, 0);  // its front, cross(x, y) = +z, is turned away
  RayScene rays(scene);
  for (const int log2 : {0, 1, 3, 6}) {
    for (const bool back : {true, false}) {
      BakedLight light;
      light.layers.push_back({});
      const std::size_t r = std::size_t{1} << log2;
      for (std::uint32_t t = 0; t < 2; ++t) {
        light.resolutions.push_back(
            {static_cast<std::uint8_t>(back ? 0 : log2), static_cast<std::uint8_t>(back ? log2 : 0)});
        const std::vector<std::uint32_t> other(3, PackShared({7, 7, 7}));
        if (back) light.samples.insert(light.samples.end(), other.begin(), other.end());
        for (std::size_t j = 0; j <= r; ++j) {
          for (std::size_t i = 0; i + j <= r; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(r),
                        v = static_cast<float>(j) / static_cast<float>(r);
            const glm::vec3 x = (1 - u - v) * rays.Corner(t, 0) + u * rays.Corner(t, 1) + v * rays.Corner(t, 2);
            light.samples.push_back(PackShared({1 + (x.x + 3) / 6, 1 + (x.y + 3) / 6, 1}));
          }
        }
        if (!back) light.samples.insert(light.samples.end(), other.begin(), other.end());
      }
      rays.SetLight(light);
      for (const KernelChoice& kernel : PacketKernels()) {
        for (float y0 = -1.4f; y0 < 1.3f; y0 += 0.37f) {
          RaySample sample{};
          for (int c = 0; c < 3; ++c) sample.rotation[c][c] = 1;
          if (!back) sample.rotation[2][2] = -1, sample.rotation[0][0] = -1, sample.origin[2] = 4;
          for (float& factor : sample.layer_factors[0]) factor = 0.5f;
          PixelBlock block{};
          for (int i = 0; i < kLanes; ++i) {
            block.x.v[i] = -1.45f + 0.19f * static_cast<float>(i), block.y.v[i] = y0 + 0.01f * static_cast<float>(i);
            block.z.v[i] = 1.0f, block.width.v[i] = 0.01f;
            block.valid.v[i] = -1;
          }
          Lanes sum[3];
          kernel.expose_block(rays.packet_scene(), &sample, 1, false, 1.0f, block, sum);
          for (int i = 0; i < kLanes; ++i) {
            const float x = 2 * block.x.v[i] * (back ? 1.0f : -1.0f), y = 2 * block.y.v[i];
            EXPECT_NEAR(sum[0].v[i], 0.5f * (1 + (x + 3) / 6), 0.002f)
                << log2 << ", " << back << ": " << x << ", " << y;
            EXPECT_NEAR(sum[1].v[i], 0.5f * (1 + (y + 3) / 6), 0.002f)
                << log2 << ", " << back << ": " << x << ", " << y;
          }
        }
      }
    }
  }
}

// White furnace as an image: e + a e / (1 - a).
TEST(BakedPicture, WhiteFurnace) {
  Scene scene;
  AddMaterial(scene, {0.5f, 0.8f, 0.25f}, {1.0f, 0.2f, 3.0f});
  AddBox(scene, {-1, -2, -3}, {2, 2, 3}, 0);
  const RadianceImage image =
      Render(*MakeBaked(scene, LightMode::baked, Every(1.0, 0.5)), Camera(SmallCamera()), TiltedPose());
  glm::dvec3 mean(0.0);
  const int n = image.width * image.height;
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) mean[c] += static_cast<double>(image.rgb[static_cast<std::size_t>(3 * i + c)]) / n;
  }
  // Variance of a path's number of hits: a / (1 - a)^2, a = 0.8 at the worst. With 256 paths at each of about 30
  // visible samples: 0.05 of e = 0.2 in the green, of a sum of 1.
  EXPECT_NEAR(mean.x / 2.0, 1, 0.02);
  EXPECT_NEAR(mean.y / 1.0, 1, 0.04);
  EXPECT_NEAR(mean.z / 4.0, 1, 0.02);
}

// Shadow of a plate between a point light and a floor: the three light modes agree away from its edge.
TEST(BakedPicture, ShadowsAreWhereTheyShouldBe) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.5f));
  AddMaterial(scene, glm::vec3(0.0f));  // no bounces
  AddQuad(scene, {-3, -3, 3}, {0, 6, 0}, {6, 0, 0}, 0);
  AddQuad(scene, {-0.4f, -0.4f, 2}, {0.15f, 0.9f, 0}, {0.7f, -0.13f, 0}, 1);
  scene.lights = {PointLight{{0.1, 0.2, 0.5}, {9, 8, 7}, {}}};
  const Camera camera(SmallCamera(160, 120));
  const RadianceImage direct = Render(scene, camera, {}, Centred());
  const RadianceImage indirect = Render(*MakeBaked(scene, LightMode::baked_indirect, Every()), camera, {});
  const RadianceImage baked = Render(*MakeBaked(scene, LightMode::baked, Every()), camera, {});
  int differ = 0, dark = 0;
  for (std::size_t i = 0; i < direct.rgb.size(); i += 3) {
    EXPECT_EQ(direct.rgb[i], indirect.rgb[i]);
    const double error = std::abs(direct.rgb[i] - baked.rgb[i]);
    if (error > 0.02 * direct.rgb[i] + 1e-3) ++differ;
    if (direct.rgb[i] == 0) ++dark;
  }
  EXPECT_GT(dark, 1000);
  // The shadow's edge is about 240 pixels long; samples are 0.012 m apart, a quarter of a pixel.
  EXPECT_LT(differ, 240);
  EXPECT_GT(differ, 10);  // control: the baked shadow is not the traced one
}

// Light leaks: radiance in a dark room beside a lit one, with a wall of zero thickness between them.
TEST(BakedPicture, NothingLeaksThroughAWall) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.7f));
  AddBox(scene, {0, 0, 0}, {2, 2, 2}, 0);
  AddBox(scene, {2, 0, 0}, {4, 2, 2}, 0);
  scene.lights = {PointLight{{1, 1.5, 1}, {5, 5, 5}, {}}};
  const Pose from_dark{{3, 1, 1.7}, {1, 0, 0, 0}};
  const glm::dquat back(0, 0, 1, 0);  // half a turn about y: looks along -z
  const Camera camera(SmallCamera());
  for (const LightMode mode : {LightMode::baked, LightMode::baked_indirect}) {
    const auto renderer = MakeBaked(scene, mode, Every(0.25, 0.1, 64));
    EXPECT_THAT(Render(*renderer, camera, {from_dark.p_WC, back}).rgb, testing::Each(0.0f));
    EXPECT_THAT(Render(*renderer, camera, {{1, 1, 1.7}, back}).rgb, testing::Each(testing::Gt(0.05f)));
  }
}

// Form factor of an opening: the middle of the floor of an open box with black walls, under a uniform sky.
TEST(BakedPicture, SkyThroughAnOpening) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddMaterial(scene, glm::vec3(0.0f));
  AddQuad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  AddQuad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, 1);
  AddQuad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 2, 0}, 1);
  AddQuad(scene, {-1, 0, -1}, {0, 0, 2}, {0, 2, 0}, 1);
  AddQuad(scene, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, 1);
  scene.sky = Sky{glm::vec3(2), glm::vec3(2), glm::vec3(2), 0, 0, {}, 0.0};
  const glm::dquat down(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
  const Pose above{{0, 1.5, 0}, glm::normalize(down)};
  CameraParams narrow = SmallCamera(5, 5);
  narrow.fx = narrow.fy = 100;
  const RadianceImage image =
      Render(*MakeBaked(scene, LightMode::baked, Every(0.5, 0.02, 4096)), Camera(narrow), above);
  // F = 4 * 1/(2 pi) * 2 A atan(A), A = X / sqrt(1 + X^2): four quarters of the opening, each with X = Y = 1/2.
  const double x = 0.5, a = x / std::sqrt(1 + x * x),
               factor = 4 / (2 * std::numbers::pi) * 2 * a * std::atan(x / std::sqrt(1 + x * x));
  EXPECT_NEAR(image.pixel(2, 2)[0] / (2 * factor), 1.0, 0.02);  // 4096 stratified paths: 1 %
}

}  // namespace
}  // namespace sim::test
