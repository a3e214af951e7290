// The inner loop's texture filter against a second implementation and closed forms.
#include <gtest/gtest.h>

#include "tests/unit/sim/render/worlds.h"
#include "tests/unit/sim/world/texture_sample.h"

namespace sim::test {
namespace {

std::vector<std::uint8_t> Noise(int width, int height) {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < width * height * 3; ++i)
    rgb.push_back(static_cast<std::uint8_t>((static_cast<unsigned>(i) * 2654435761u) >> 24));
  return rgb;
}

// A textured quad of 2 x 2 m, upper left corner (-1, -1), at distance z in front of the camera.
Scene Picture(int width, int height, float z) {
  Scene scene;
  scene.textures.emplace_back("noise", width, height, Noise(width, height));
  AddMaterial(scene, glm::vec3(1.0f), glm::vec3(0.0f), 0);
  AddQuad(scene, {-1, -1, z}, {2, 0, 0}, {0, 2, 0}, 0);
  scene.lights.push_back(AmbientLight{{1, 1, 1}});
  return scene;
}

// One texel per pixel, centre on centre: the image is the texture, upright.
TEST(TextureLookup, TexelCentres) {
  const int size = 64;
  Scene scene = Picture(size, size, 1.0f);
  CameraParams params = SmallCamera(size, size);
  params.fx = params.fy = size / 2.0;  // 2 m at 1 m
  const RadianceImage image = Render(scene, Camera(params), Pose{});
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec3 expected = scene.textures[0].Texel(0, x, y);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.pixel(x, y)[c], expected[c], 1e-4) << x << ", " << y;
    }
  }
}

TEST(TextureLookup, AgreesWithTheTexturesOwnFilterAtAllDistances) {
  for (const float z : {0.3f, 1.0f, 1.7f, 3.3f, 9.0f, 40.0f}) {
    const Scene scene = Picture(60, 100, z);  // sides that are not powers of two
    const Camera camera(SmallCamera(64, 64));
    const Pose pose{{0.013, -0.007, 0.0}, {1, 0, 0, 0}};
    const RadianceImage image = Render(scene, camera, pose);
    const double texels = z / 70.0 * std::sqrt(60.0 * 100.0 / 4.0);  // a pixel's side at z, in texels
    int seen = 0;
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        const glm::dvec3 x = pose.p_WC + static_cast<double>(z) * RayInWorld(camera, pose, u, v);
        const glm::vec2 uv((x.x + 1) / 2, (x.y + 1) / 2);
        if (uv.x < 0.01f || uv.x > 0.99f || uv.y < 0.01f || uv.y > 0.99f) continue;
        ++seen;
        const glm::vec3 expected = Sample(scene.textures[0], uv, static_cast<float>(texels));
        // Error of the loop's log2: 0.01 mip levels, and neighbouring levels differ by less than 1. Error of uv: 1e-5
        // texels x 100.
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.pixel(u, v)[c], expected[c], 0.01) << z << ": " << u << ", " << v;
      }
    }
    EXPECT_GT(seen, 2);
  }
}

TEST(TextureLookup, RepeatsOutsideAndFarAway) {
  Scene near = Picture(32, 32, 1.0f), far = near;
  for (glm::vec2& uv : far.meshes[0].uvs) uv += glm::vec2(-7.0f, 12.0f);
  const Camera camera(SmallCamera(64, 64));
  const RadianceImage a = Render(near, camera, Pose{}), b = Render(far, camera, Pose{});
  for (std::size_t i = 0; i < a.rgb.size(); ++i) ASSERT_NEAR(a.rgb[i], b.rgb[i], 2e-4);
}

TEST(TextureLookup, MinifiedPictureIsItsMean) {
  const Scene scene = Picture(100, 60, 2000.0f);  // less than a tenth of a pixel
  Scene wall = scene;
  for (glm::vec3& p : wall.meshes[0].positions) p.x *= 1000, p.y *= 1000;
  for (glm::vec2& uv : wall.meshes[0].uvs) uv *= 1000.0f;
  const RadianceImage image = Render(wall, Camera(SmallCamera(8, 8)), Pose{});
  glm::dvec3 mean(0);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 100; ++x) mean += glm::dvec3(scene.textures[0].Texel(0, x, y)) / 6000.0;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(3, 4)[c], mean[c], 1.0 / 1023);  // the coding's step
}

TEST(TextureLookup, VertexColoursMultiply) {
  Scene scene = Picture(4, 4, 1.0f);
  scene.textures.clear();
  scene.textures.emplace_back("grey", 1, 1, std::vector<std::uint8_t>{255, 255, 255});
  scene.materials[0].base_color = {0.5f, 1.0f, 1.0f};
  scene.meshes[0].colors = {{1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {0, 0, 1}};
  AddQuad(scene, {-1, -1, 2}, {9, 0, 0}, {0, 9, 0}, 0);  // a mesh without colours beside: white
  const Camera camera(SmallCamera(63, 63));
  const RadianceImage image = Render(scene, camera, Pose{});
  const glm::dvec2 uv(0.25, 0.125);  // below the diagonal: the triangle of corners 0, 1, 2
  const Pose at{{2 * uv.x - 1, 2 * uv.y - 1, 0}, {1, 0, 0, 0}};
  const RadianceImage seen = Render(scene, camera, at);
  // Triangle (0, 1, 2): weights 1 - u, u - v, v of red, green, white.
  EXPECT_NEAR(seen.pixel(31, 31)[0], 0.5 * (0.75 + 0.125), 1e-5);
  EXPECT_NEAR(seen.pixel(31, 31)[1], 0.125 + 0.125, 1e-5);
  EXPECT_NEAR(seen.pixel(31, 31)[2], 0.125, 1e-5);
  const RadianceImage beside = Render(scene, camera, Pose{{5, 5, 0}, {1, 0, 0, 0}});
  EXPECT_NEAR(beside.pixel(31, 31)[0], 0.5, 1e-5);
  EXPECT_NEAR(beside.pixel(31, 31)[1], 1.0, 1e-5);
}

void ExpectNothingNegative(const RadianceImage& image) {
  for (const float light : image.rgb) ASSERT_GE(light, 0.0f);
}

// Rounding of barycentric weights near zero: beside black a negative weight would give negative radiance.
TEST(TextureLookup, NothingIsNegativeOnABlackEdge) {
  Scene scene = Picture(1, 1, 1.0f);
  scene.meshes[0].colors = {{0, 0, 0},
                            {0.3f, 0.7f, 0.9f},
                            {0, 0, 0},
                            {0.9f, 0.3f, 0.7f}};  // black along the diagonal, where the triangles meet
  for (int i = 0; i < 100; ++i) {
    const double by = 0.003 * i;
    ExpectNothingNegative(Render(scene, Camera(SmallCamera(63, 63)), Pose{{by, by, -0.01 * i}, {1, 0, 0, 0}}));
  }
}

TEST(TextureLookup, NothingIsNegativeAtABlackTexel) {
  const int size = 64;
  std::vector<std::uint8_t> stripes;
  for (int i = 0; i < 3 * size * size; ++i) stripes.push_back(i / 3 % 2 == 0 ? 0 : 255);
  Scene scene = Picture(size, size, 1.0f);
  scene.textures[0] = Texture("stripes", size, size, stripes);
  CameraParams params = SmallCamera(size, size);
  params.fx = params.fy = size / 2.0;  // one texel per pixel, centre on centre
  for (int i = 0; i < 20; ++i)
    ExpectNothingNegative(Render(scene, Camera(params), Pose{{0, 1e-3 * i, 0}, {1, 0, 0, 0}}));
}

}  // namespace
}  // namespace sim::test
