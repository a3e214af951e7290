// Rasteriser: threads, strips of rows, lenses, refusals.
#include <gmock/gmock.h>

#include <thread>

#include "sim/render/raster_view.h"
#include "tests/unit/sim/render/engines.h"

namespace sim::test {
namespace {

RasteriserOptions On(const EngineUnderTest& engine) {
  RasteriserOptions options;
  options.platform = engine.platform;
  return options;
}

RadianceImage Expose(const Renderer& renderer, const Camera& camera, const Trajectory& motion,
                     const Exposure& exposure) {
  RadianceImage image;
  renderer.Expose(camera, motion, exposure, 1, image);
  return image;
}

class RasteriserTest : public EngineTest {};
INSTANTIATE_TEST_SUITE_P(Engine, RasteriserTest, testing::Values(kEgl, kOsmesa), EngineName);

// Image as a function of the arguments alone: no influence of concurrent calls, of earlier calls with other cameras and
// exposures, or of another rasteriser in the same process, on any platform.
TEST_P(RasteriserTest, ResultsDependOnTheArgumentsAlone) {
  const SteadyMotion motion(Pose{}, {0.8, 0.4, 0.1}, {0.05, -0.1, 0.15});
  const Camera small(SmallCamera()), distorted(DistortedCamera());
  const Exposure blur{0.0, 0.1, 0.0, 4}, rolling{0.1, 0.02, 1e-4, 3};
  const auto renderer = MakeRasteriser(BusyWorld(), On(GetParam())),
             again = MakeRasteriser(BusyWorld(), On(GetParam()));
  const auto other = MakeRasteriser(BusyWorld());
  const RadianceImage a = Expose(*renderer, small, motion, blur), b = Expose(*again, distorted, motion, rolling);
  RadianceImage c, d;
  std::thread one([&] {
    for (int i = 0; i < 5; ++i) c = Expose(*renderer, small, motion, blur);
  });
  std::thread two([&] {
    for (int i = 0; i < 5; ++i) d = Expose(*renderer, distorted, motion, rolling);
  });
  std::thread three([&] {
    for (int i = 0; i < 5; ++i) Expose(*other, small, motion, rolling);
  });
  one.join(), two.join(), three.join();
  EXPECT_EQ(a.rgb, c.rgb);
  EXPECT_EQ(b.rgb, d.rgb);
  EXPECT_NE(a.rgb, Expose(*renderer, small, motion, rolling).rgb);
}

TEST_P(RasteriserTest, NothingIsBackground) {
  Scene scene;
  scene.background = {0.25f, 0.5f, 1.5f};
  scene.lights = BusyWorld().lights;
  const auto renderer = MakeRasteriser(scene, On(GetParam()));
  const RadianceImage image = Expose(*renderer, Camera(SmallCamera(9, 5)), SteadyMotion(Pose{}), Exposure{});
  ASSERT_EQ(image.rgb.size(), 9u * 5u * 3u);
  EXPECT_EQ(image.pixel(8, 4)[0], 0.25f);
  EXPECT_EQ(image.pixel(8, 4)[1], 0.5f);
  EXPECT_EQ(image.pixel(8, 4)[2], 1.5f);
}

// Mean place of an image's samples: the pixel's centre, for any number. An edge at 41.0 covers half of pixel 41.
TEST_P(RasteriserTest, SamplesDoNotShiftThePicture) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  AddQuad(scene, {0.0f, -9, 1}, {9, 0, 0}, {0, 18, 0}, 0);
  for (const int count : {2, 3, 7, 16, 64}) {
    const auto renderer = MakeRasteriser(scene, On(GetParam()));
    const RadianceImage image =
        Expose(*renderer, Camera(SmallCamera(83, 4)), SteadyMotion(Pose{}), Exposure{0.0, 0.0, 0.0, count});
    double bright = 0;
    for (int x = 0; x < 83; ++x) bright += image.pixel(x, 1)[0];
    EXPECT_NEAR(82.5 - bright, 41.0, 0.5 / count + 1.0 / 256) << count;  // a step of one sample
  }
}

// Centroid of a defocused square in the middle of the image: not shifted by a blur disc of 28 px radius.
TEST_P(RasteriserTest, ALensDoesNotShiftWhatItBlurs) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  AddQuad(scene, {-0.2f, -0.2f, 2}, {0.4f, 0, 0}, {0, 0.4f, 0}, 0);
  const auto renderer = MakeRasteriser(scene, On(GetParam()));
  CameraParams params = SmallCamera(161, 161);
  params.fx = params.fy = 280;
  for (const int count : {1, 2, 3, 4, 7}) {
    const RadianceImage image =
        Expose(*renderer, Camera(params), SteadyMotion(Pose{}), Exposure{0.0, 0.0, 0.0, count, 0.4, 1.0});
    double sum = 0, x_sum = 0, y_sum = 0;
    for (int y = 0; y < 161; ++y) {
      for (int x = 0; x < 161; ++x) {
        const double light = image.pixel(x, y)[0];
        sum += light, x_sum += x * light, y_sum += y * light;
      }
    }
    EXPECT_NEAR(x_sum / sum, 80, 0.5) << count;  // a sample's edges are at whole pixels
    EXPECT_NEAR(y_sum / sum, 80, 0.5) << count;
  }
}

// Skew of the edge of sampling_test.cpp under a rolling shutter, by strips with the time of their middle row: exact for
// strips of one row, off by the rotation during up to three and a half rows for strips of eight.
TEST_P(RasteriserTest, RollingShutterStrips) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  AddQuad(scene, {0.1f, -9, 1}, {9, 0, 0}, {0, 18, 0}, 0);
  CameraParams params = SmallCamera(80, 60);
  constexpr double w = 2.0, delay_s = 5e-4;
  for (const int strip : {1, 8}) {
    RasteriserOptions options = On(GetParam());
    options.rays_per_time_sample = 128;
    options.strip_rows = strip;
    const RadianceImage image = Expose(*MakeRasteriser(scene, options), Camera(params),
                                       SteadyMotion(Pose{}, {}, {0, w, 0}), Exposure{0.0, 0.0, delay_s, 1});
    for (int y = 0; y < 60; ++y) {
      double bright = 0;
      for (int x = 0; x < 80; ++x) bright += image.pixel(x, y)[0];
      const int begin = y / strip * strip, end = std::min(60, begin + strip);
      const double middle = 0.5 * (begin + end - 1);
      const double edge = params.cx + params.fx * std::tan(std::atan(0.1) - w * delay_s * (middle - 29.5));
      EXPECT_NEAR(79.5 - bright, edge, 1.0 / 128 + 1.0 / 256) << strip << ": " << y;
    }
  }
}

TEST_P(RasteriserTest, RefusesWhatItCannotDo) {
  RasteriserOptions options = On(GetParam());
  options.rays_per_time_sample = 0, options.strip_rows = 0, options.shadow_map_side = 1;
  try {
    MakeRasteriser(BusyWorld(), options);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "rasteriser: rays_per_time_sample = 0 must lie in 1 ... 4096; shadow_map_side = 1 must lie in 16 ... "
                 "8192; strip_rows = 0 must lie in 1 ... 16384");
  }
  Scene scene = BusyWorld();
  scene.meshes[0].material = 2;
  EXPECT_THROW(MakeRasteriser(scene, On(GetParam())), std::invalid_argument);

  const auto renderer = MakeRasteriser(BusyWorld(), On(GetParam()));
  EXPECT_THROW(Expose(*renderer, Camera(SmallCamera()), SteadyMotion(Pose{}), Exposure{0, 0, 0, 0}),
               std::invalid_argument);
  // A lens whose pixels are 800 times narrower in the middle than at the border.
  CameraParams params = SmallCamera(640, 480);
  params.lens = Lens::fisheye;
  params.fx = params.fy = 20000;
  params.k1 = -0.0, params.k2 = 0;
  params.width = 16384, params.height = 16;
  params.cx = 8191.5, params.cy = 7.5;
  EXPECT_THROW(Expose(*renderer, Camera(params), SteadyMotion(Pose{}), Exposure{}), std::invalid_argument);
  // The renderer stays usable.
  EXPECT_NO_THROW(Expose(*renderer, Camera(SmallCamera()), SteadyMotion(Pose{}), Exposure{}));
}

TEST_P(RasteriserTest, NamesWhatItDoesNotRender) {
  std::vector<std::string> warnings;
  MakeRasteriser(BusyWorld(), On(GetParam()), &warnings);
  EXPECT_THAT(warnings, testing::IsEmpty());

  Scene scene = BusyWorld();
  scene.materials[0].name = "wall", scene.materials[1].name = "ball";
  scene.textures.emplace_back("bumps", 1, 1, std::vector<std::uint8_t>{128, 128, 255}, std::span<const std::uint8_t>(),
                              Texture::Content::numbers);
  scene.materials[0].normal_map = scene.materials[1].normal_map = 1;
  scene.materials[0].emission_texture = 0;
  scene.materials[0].emission = glm::vec3(1.0f);
  scene.materials[0].alpha_cutoff = 0.5f, scene.materials[0].alpha = 0.25f;
  for (Mesh& mesh : scene.meshes) mesh.uvs.resize(mesh.positions.size());
  std::get<RectLight>(scene.lights[3]).visible = true;
  std::get<PointLight>(scene.lights[1]).flicker = {100, 0.5, 0};
  scene.sky.emplace();
  MakeRasteriser(scene, On(GetParam()), &warnings);
  EXPECT_THAT(warnings,
              testing::ElementsAre("rasteriser: 2 × normal maps are not rendered (first: material 'wall': ...)",
                                   "rasteriser: material 'wall': of pictures that shine only the mean is rendered",
                                   "rasteriser: material 'wall': nothing is cut out of surfaces",
                                   "rasteriser: lamps do not flicker", "rasteriser: visible lamps are not seen",
                                   "rasteriser: the sky is not seen; world.background is"));
}

// View of each face: contains every ray of the lens, at the borders of its pixels too.
TEST(RasterViews, HoldEveryRay) {
  CameraParams fisheye = SmallCamera(97, 61);
  fisheye.lens = Lens::fisheye;
  fisheye.fx = fisheye.fy = 25;  // 131 degrees from the axis in the corners
  CameraParams wide = SmallCamera(97, 61);
  wide.fx = wide.fy = 24;
  wide.k1 = 0.01;
  for (const CameraParams& params : {fisheye, wide, DistortedCamera(), SmallCamera()}) {
    const Camera camera(params);
    for (const int rows : {params.height, 8, 1}) {
      const RasterViews views = MakeRasterViews(camera, rows, 0.0, 4096);
      EXPECT_EQ(views.one_face, params.fx > 30);
      int checked = 0;
      for (const RasterStrip& strip : views.strips) {
        for (int y = strip.begin; y < strip.end; ++y) {
          for (int k = 0; k < 5 * params.width; ++k) {
            const float u = static_cast<float>(k) / 5 - 0.4f,
                        v = static_cast<float>(y) - 0.4f + 0.2f * static_cast<float>(k % 5);
            const glm::vec3 ray = camera.Ray(u, v);
            const int face = views.one_face ? 0 : FaceOf(ray);
            const glm::vec3 d = FaceFromCamera(face) * ray;
            ASSERT_GT(d.z, 0);
            const auto view = std::find_if(strip.views.begin(), strip.views.end(),
                                           [&](const RasterView& w) { return w.face == face; });
            ASSERT_NE(view, strip.views.end()) << u << ", " << v << ": face " << face;
            const glm::vec2 at = (glm::vec2(d.x / d.z, d.y / d.z) - view->low) / view->texel;
            ASSERT_TRUE(at.x >= 0 && at.y >= 0 && at.x <= static_cast<float>(view->width) &&
                        at.y <= static_cast<float>(view->height))
                << u << ", " << v << ": face " << face << " at " << at.x << ", " << at.y << " of " << view->width
                << " x " << view->height;
            ++checked;
          }
        }
      }
      EXPECT_EQ(checked, 5 * params.width * params.height);
    }
  }
}

}  // namespace
}  // namespace sim::test
