// Sky, cut-outs, emission, normal maps, visible lamps and flicker by the ray tracer, in closed form.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Surface, SkyIsSeenAsItIsDescribed) {
  const Camera camera(SmallCamera(160, 120));
  Sky picture{{}, {}, {}, 12, 6, {}, 0.3};
  for (int i = 0; i < 72; ++i)
    picture.picture.emplace_back(0.1f * static_cast<float>(i % 12), 0.2f * static_cast<float>(i / 12),
                                 static_cast<float>(i % 5));
  const Sky gradient{{1, 2, 3}, {0.5f, 0.25f, 4}, {0, 1, 0}, 0, 0, {}, 0.0};
  for (const Sky& sky : {gradient, picture}) {
    Scene scene;
    scene.sky = sky;
    for (const glm::dquat& q :
         {glm::dquat(1, 0, 0, 0), glm::normalize(glm::dquat(0.2, 0.8, -0.3, 0.5)),
          glm::normalize(glm::dquat(0.1, -0.9, 0.2, 0.9)), glm::normalize(glm::dquat(-0.1, 0.1, 0.9, 0.2))}) {
      const Pose pose{{1, 2, 3}, q};
      const RadianceImage image = Render(scene, camera, pose);
      for (int v = 0; v < 120; ++v) {
        for (int u = 0; u < 160; ++u) {
          const glm::dvec3 expected = sky.Radiance(glm::normalize(RayInWorld(camera, pose, u, v)));
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(image.pixel(u, v)[c], expected[c], 2e-4) << u << ", " << v << ", " << c;
        }
      }
    }
  }
}

// Chequered cut-out (alpha test) of 2 x 2 texels in front of a white wall: visibility and shadow.
Texture Chequer() {
  const std::vector<std::uint8_t> rgb(12, 255), alpha{255, 0, 0, 255};
  return Texture("chequer", 2, 2, rgb, alpha);
}

TEST(Surface, CutOutsInPrimaryAndShadowRays) {
  Scene scene;
  scene.textures.push_back(Chequer());
  AddMaterial(scene, glm::vec3(0.0f), {0, 1, 0}, 0);  // green where it is
  scene.materials[0].alpha_cutoff = 0.5f;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, 0);
  AddQuad(scene, {-20, -20, 4}, {0, 40, 0}, {40, 0, 0}, 1);
  scene.lights = {SunLight{{0.5, 0.25, 1.0}, {kPi, kPi, kPi}}};
  const double cosine = 1 / std::sqrt(1 + 0.25 + 0.0625);
  // The texture is bilinear and repeats: alpha = 1/2 + (tent(s) tent(t)) / 2, above 1/2 where both tents have the same
  // sign.
  const auto is_there = [](double x, double y) {
    if (std::abs(x) > 1 || std::abs(y) > 1) return false;
    const auto tent = [](double s) {
      return std::abs(s - std::floor(s) - 0.75) < 0.25 || std::abs(s - std::floor(s) + 0.25) < 0.25 ||
             s - std::floor(s) > 0.5;
    };
    return tent((x + 1) / 2) == tent((y + 1) / 2);
  };
  const Camera camera(SmallCamera(121, 91));
  const RadianceImage image = Render(scene, camera, {});
  int there = 0, shadow = 0, lit = 0;
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      const glm::dvec3 ray = RayInWorld(camera, {}, u, v);
      const double x = 2 * ray.x, y = 2 * ray.y, sx = 4 * ray.x - 1.0, sy = 4 * ray.y - 0.5;
      const auto near_edge = [](double a, double b) {
        return std::min({std::abs(a), std::abs(b), std::abs(std::abs(a) - 1), std::abs(std::abs(b) - 1)}) < 1e-3;
      };
      if (near_edge(x, y) || near_edge(sx, sy)) continue;
      const float* pixel = image.pixel(u, v);
      if (is_there(x, y)) {
        ++there;
        ASSERT_EQ(pixel[1], 1.0f) << u << ", " << v;
        ASSERT_EQ(pixel[0], 0.0f) << u << ", " << v;
      } else if (is_there(sx, sy)) {
        ++shadow;
        ASSERT_EQ(pixel[1], 0.0f) << u << ", " << v;
      } else {
        ++lit;
        ASSERT_NEAR(pixel[0], cosine, 1e-5) << u << ", " << v;
      }
    }
  }
  EXPECT_GT(there, 500);
  EXPECT_GT(shadow, 100);
  EXPECT_GT(lit, 1000);
  const std::vector<float> depth = DepthOf(*MakeRayTracer(scene), camera, Pose{});
  EXPECT_NEAR(depth[40 * 121 + 55],
              is_there(2 * RayInWorld(camera, {}, 55, 40).x, 2 * RayInWorld(camera, {}, 55, 40).y) ? 2 : 4, 1e-6);
}

TEST(Surface, FactorBelowTheCutoffIsNowhere) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f), {1, 1, 1});
  scene.materials[0].alpha = 0.4f;
  scene.materials[0].alpha_cutoff = 0.5f;
  AddQuad(scene, {-9, -9, 2}, {18, 0, 0}, {0, 18, 0}, 0);
  EXPECT_THAT(Render(scene, Camera(SmallCamera()), {}).rgb, testing::Each(0.0f));
  scene.materials[0].alpha = 0.6f;
  EXPECT_THAT(Render(scene, Camera(SmallCamera()), {}).rgb, testing::Each(1.0f));
}

TEST(Surface, EmissionTimesItsPicture) {
  Scene scene;
  const std::vector<std::uint8_t> rgb{255, 0, 0, 0, 255, 0};
  scene.textures.emplace_back("red and green", 2, 1, rgb);
  AddMaterial(scene, glm::vec3(0.0f), {2, 3, 4});
  scene.materials[0].emission_texture = 0;
  AddMaterial(scene, glm::vec3(0.0f), {5, 6, 7});  // without a picture
  AddQuad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 1, 0}, 0);
  AddQuad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 1, 0}, 1);
  const Camera camera(SmallCamera(81, 61));
  const RadianceImage image = Render(scene, camera, {});
  const auto at = [&](double x, double y) {
    return image.pixel(static_cast<int>(40 + 70 * x), static_cast<int>(30 + 70 * y));
  };
  EXPECT_NEAR(at(-0.5, -0.3)[0], 2, 0.02);  // texel centres are at x = -0.5 and 0.5
  EXPECT_NEAR(at(-0.5, -0.3)[1], 0, 0.03);
  EXPECT_NEAR(at(0.5, -0.3)[1], 3, 0.03);
  EXPECT_NEAR(at(0.0, -0.3)[0], 1, 0.03);
  EXPECT_EQ(at(0.2, 0.3)[0], 5.0f);
}

// Cosine between a sun and the normal of a uniformly tilting normal map; from behind, with its opposite. Upright and
// mirrored texture coordinates. Control: the wrong sign of the green channel.
TEST(Surface, NormalMapTurnsTheNormal) {
  const glm::dvec3 tilted = glm::normalize(glm::dvec3(0.4, 0.3, 1.0));  // right, up, out
  const auto code = [](double n) { return static_cast<std::uint8_t>(std::lround((n + 1) / 2 * 255)); };
  const std::vector<std::uint8_t> rgb{code(tilted.x), code(tilted.y), code(tilted.z)};
  const SunLight sun{{0.2, 0.4, 1.0}, {kPi, kPi, kPi}};
  const glm::dvec3 towards = -glm::normalize(sun.direction);
  for (const bool mirrored : {false, true}) {
    for (const double scale : {1.0, 0.5}) {
      Scene scene;
      scene.textures.emplace_back("tilt", 1, 1, rgb, std::vector<std::uint8_t>(), Texture::Content::numbers);
      AddMaterial(scene, glm::vec3(1.0f));
      scene.materials[0].normal_map = 0;
      scene.materials[0].normal_scale = static_cast<float>(scale);
      AddQuad(scene, {-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, 0);  // its front is at -z
      for (glm::vec2& uv : scene.meshes[0].uvs)
        uv = {mirrored ? -uv.y : uv.y, uv.x};  // u to the right (+x), v down (+y)
      const glm::dvec3 right(mirrored ? -1 : 1, 0, 0), up(0, -1, 0), out(0, 0, -1);
      const glm::dvec3 n = glm::normalize(scale * tilted.x * right + scale * tilted.y * up + tilted.z * out);
      const glm::dvec3 wrong = glm::normalize(scale * tilted.x * right - scale * tilted.y * up + tilted.z * out);
      for (const bool with_normals : {false, true}) {
        if (with_normals) scene.meshes[0].normals.assign(4, glm::vec3(out));
        scene.lights = {sun};
        const RadianceImage image = Render(scene, Camera(SmallCamera()), {});
        EXPECT_NEAR(image.pixel(20, 30)[0], glm::dot(n, towards), 0.01);  // eight bits of the map
        EXPECT_GT(std::abs(image.pixel(20, 30)[0] - glm::dot(wrong, towards)), 0.05)
            << "the green channel upside down must show";
        scene.lights = {SunLight{-sun.direction, sun.irradiance}};
        const Pose behind{{0, 0, 4}, {0, 0, 1, 0}};
        EXPECT_NEAR(Render(scene, Camera(SmallCamera()), behind).pixel(20, 30)[0], glm::dot(-n, -towards), 0.01);
      }
    }
  }
}

TEST(Surface, ANormalMapTurnsNoOtherMaterial) {
  Scene scene;
  const std::vector<std::uint8_t> grey{128, 128, 128};
  scene.textures.emplace_back("grey", 1, 1, grey);
  scene.textures.emplace_back("tilt", 1, 1, grey, std::vector<std::uint8_t>(), Texture::Content::numbers);
  AddMaterial(scene, glm::vec3(1.0f), glm::vec3(0.0f), 0);
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-9, -9, 2}, {18, 0, 0}, {0, 18, 0}, 0);
  AddQuad(scene, {-9, -9, 3}, {18, 0, 0}, {0, 18, 0}, 1);  // behind the other
  scene.lights = {SunLight{{1, 0, 1}, {kPi, kPi, kPi}}};
  const float plain = Render(scene, Camera(SmallCamera()), {}).pixel(20, 30)[0];
  scene.materials[1].normal_map = 1;
  EXPECT_NEAR(Render(scene, Camera(SmallCamera()), {}).pixel(20, 30)[0] / plain, 1.0, 1e-6);
}

TEST(Surface, VisibleLampIsSeenFromItsSideAndCastsNoShadow) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-20, -20, 4}, {0, 40, 0}, {40, 0, 0}, 0);
  RectLight lamp{{-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}, {3, 2, 1}};  // shines towards -z
  lamp.visible = true;
  scene.lights = {lamp, SunLight{{0, 0, 1}, {kPi, kPi, kPi}}};
  const Camera camera(SmallCamera(81, 61));
  const RadianceImage front = Render(scene, camera, {});
  EXPECT_FLOAT_EQ(front.pixel(40, 30)[0], 3.0f);
  EXPECT_FLOAT_EQ(front.pixel(40, 30)[2], 1.0f);
  EXPECT_NEAR(front.pixel(5, 5)[0], 1.0, 1e-6) << "the wall has the sun";
  const Pose behind{{0, 0, 3}, {1, 0, 0, 0}};
  EXPECT_NEAR(Render(scene, camera, behind).pixel(40, 30)[0], 1.0, 1e-6) << "no shadow of the lamp";
  const Pose back{{0, 0, 3.5}, {0, 0, 1, 0}};  // looks at the lamp's dark side
  EXPECT_EQ(Render(scene, camera, back).pixel(40, 30)[0], 0.0f);
}

// Mean of a lamp's flicker over the exposure of each row of a rolling shutter, in each light mode.
TEST(Surface, FlickerInEachRow) {
  const Flicker mains{100, 0.4, 0.2};
  Scene steady, flickers;
  AddMaterial(steady, glm::vec3(0.5f));
  AddQuad(steady, {-9, -9, 2}, {18, 0, 0}, {0, 18, 0}, 0);
  flickers = steady;
  steady.lights = {PointLight{{0.3, 0.1, 1}, {5, 5, 5}}};
  flickers.lights = {PointLight{{0.3, 0.1, 1}, {5, 5, 5}, mains}};
  const Camera camera(SmallCamera(17, 61));
  for (const LightMode mode : {LightMode::direct, LightMode::baked, LightMode::baked_indirect}) {
    for (const double row_delay_s : {0.0, 2e-4, -2e-4}) {
      for (const int time_samples : {1, 3}) {
        Exposure exposure;
        exposure.middle_s = 0.123;
        exposure.exposure_s = 0.004;
        exposure.row_delay_s = row_delay_s;
        exposure.time_samples = time_samples;
        const BakeParams bake{1.0, 0.5, 16, 16};
        RadianceImage a, b;
        MakeBaked(steady, mode, bake)->Expose(camera, SteadyMotion({}), exposure, 1, a);
        MakeBaked(flickers, mode, bake)->Expose(camera, SteadyMotion({}), exposure, 1, b);
        for (int v = 0; v < camera.height(); ++v) {
          const double expected = FlickerFactor(mains, exposure.RowMiddle(v, camera.height()), exposure.exposure_s);
          for (const int u : {0, 7, 16})
            ASSERT_NEAR(b.pixel(u, v)[1] / a.pixel(u, v)[1], expected, 2e-3) << v;  // baked light is packed
        }
      }
    }
  }
}

}  // namespace
}  // namespace sim::test
