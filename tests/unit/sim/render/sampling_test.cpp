// Exposure: time samples, antialiasing, determinism.
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

SteadyMotion Moving() { return SteadyMotion(Pose{}, {0.8, 0.4, 0.1}, {0.05, -0.1, 0.15}); }

Exposure Open(int time_samples, double exposure_s = 0.1, double row_delay_s = 0.0, double middle_s = 0.0) {
  return {middle_s, exposure_s, row_delay_s, time_samples};
}

RadianceImage Expose(const Renderer& renderer, const Trajectory& motion, const Exposure& exposure, std::uint64_t key,
                     const Camera& camera) {
  RadianceImage image;
  renderer.Expose(camera, motion, exposure, key, image);
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
  const SteadyMotion motion = Moving();
  for (const Exposure& exposure : {Open(4), Open(4, 0.01, 1e-4)}) {
    const RadianceImage image = Expose(*a, motion, exposure, 7, camera);
    Expose(*b, motion, exposure, 8, camera);  // an earlier call, without influence
    EXPECT_EQ(image.rgb, Expose(*b, motion, exposure, 7, camera).rgb);
    EXPECT_EQ(image.rgb, Expose(*c, motion, exposure, 7, camera).rgb);
    EXPECT_NE(image.rgb, Expose(*a, motion, exposure, 8, camera).rgb);  // the key matters
  }
  EXPECT_EQ(DepthOf(*a, camera, TiltedPose()), DepthOf(*b, camera, TiltedPose()));
}

double WorstDifference(const RadianceImage& a, const RadianceImage& b, const std::vector<int>& rows) {
  double worst = 0;
  for (const int y : rows) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(double{a.pixel(x, y)[c]} - b.pixel(x, y)[c]) / (1.0 + b.pixel(x, y)[c]));
      }
    }
  }
  return worst;
}

// A smooth world, without edges at which rounding decides the hit.
Scene SmoothWorld() {
  Scene scene;
  scene.textures.emplace_back("ramp", 2, 2,
                              std::vector<std::uint8_t>{10, 200, 90, 250, 30, 160, 90, 120, 20, 180, 240, 60});
  AddMaterial(scene, {0.9f, 0.8f, 0.7f}, glm::vec3(0.0f), 0);
  AddQuad(scene, {-9, -9, 4}, {18, 0, 1}, {0, 18, 1}, 0, 3.0f);
  scene.lights = {AmbientLight{{0.5, 0.5, 0.5}}, PointLight{{1, -1, 0}, {9, 8, 7}}};
  return scene;
}

TEST(Exposure, IsTheMeanOfItsTimeSamples) {
  const Camera camera(SmallCamera());
  const auto renderer = MakeRayTracer(SmoothWorld(), Centred());
  const SteadyMotion motion = Moving();
  const RadianceImage blurred = Expose(*renderer, motion, Open(5), 1, camera);
  std::vector<double> mean(blurred.rgb.size());
  for (int k = 0; k < 5; ++k) {
    const RadianceImage sharp = Expose(*renderer, motion, Open(1, 0.0, 0.0, 0.02 * (k - 2)), 1, camera);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += sharp.rgb[i] / 5.0;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) ASSERT_NEAR(blurred.rgb[i], mean[i], 2e-5 * (1 + mean[i])) << i;
}

// Row y of a rolling shutter: row y of a global shutter's image at the row's own time.
TEST(Exposure, EachRowOfARollingShutterHasItsOwnMoment) {
  const Camera camera(SmallCamera(83, 62));
  const auto renderer = MakeRayTracer(SmoothWorld(), Centred());
  const SteadyMotion motion(TiltedPose(), {0.8, 0.4, 0.1}, {0.5, -1.0, 0.7});
  for (const double delay_s : {5e-4, -5e-4}) {
    const RadianceImage rolling = Expose(*renderer, motion, Open(3, 0.006, delay_s, 0.1), 1, camera);
    for (const int y : {0, 1, 2, 3, 17, 30, 31, 59, 60, 61}) {
      const double middle_s = 0.1 + delay_s * (y - 30.5);
      EXPECT_LT(WorstDifference(rolling, Expose(*renderer, motion, Open(3, 0.006, 0.0, middle_s), 1, camera), {y}),
                2e-5)
          << y;
      // Control: one row's delay off.
      EXPECT_GT(
          WorstDifference(rolling, Expose(*renderer, motion, Open(3, 0.006, 0.0, middle_s + delay_s), 1, camera), {y}),
          1e-4)
          << y;
    }
  }
}

// cx + fx tan(atan((u0 - cx) / fx) - w t(y)): place in row y of a vertical line at u0, for a camera that turns at rate
// w about its vertical axis.
TEST(Exposure, AVerticalEdgeLeansUnderARollingShutter) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  AddQuad(scene, {0.1f, -9, 1}, {9, 0, 0}, {0, 18, 0}, 0);
  CameraParams params = SmallCamera(80, 60);
  const Camera camera(params);
  RayTracerOptions options;
  options.rays_per_time_sample = 256;
  constexpr double w = 2.0, delay_s = 5e-4;
  const RadianceImage image =
      Expose(*MakeRayTracer(scene, options), SteadyMotion(Pose{}, {}, {0, w, 0}), Open(1, 0.0, delay_s), 3, camera);
  for (int y = 0; y < 60; ++y) {
    double bright = 0;
    for (int x = 0; x < 80; ++x) bright += image.pixel(x, y)[0];
    // The edge is a line in the image too: the row's mean is its place at the row's middle.
    const double edge = params.cx + params.fx * std::tan(std::atan(0.1) - w * delay_s * (y - 29.5));
    EXPECT_NEAR(79.5 - bright, edge, 0.03) << y;
  }
}

// Jitter of the time samples within their parts of the exposure: long blur is noise about the right mean, not copies.
TEST(Exposure, FewTimeSamplesMakeGrainAroundTheRightMean) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  AddQuad(scene, {0, -9, 1}, {9, 0, 0}, {0, 18, 0}, 0);
  const Camera camera(SmallCamera(80, 60));
  // The edge sweeps from u = 39.5 + 17.5 to 39.5 - 17.5.
  const RadianceImage image =
      Expose(*MakeRayTracer(scene), SteadyMotion(Pose{{-0.25, 0, 0}}, {5, 0, 0}), Open(2, 0.1, 0, 0.05), 3, camera);
  for (const int x : {25, 30, 36, 43, 50, 54}) {
    double mean = 0;
    for (int y = 0; y < 60; ++y) mean += image.pixel(x, y)[0] / 60.0;
    const double expected = (x - 22.0) / 35.0;
    // Each pixel is 0, 1/2 or 1 with the right mean; standard deviation of 60 of them at most 1/4 / sqrt(60) = 0.033.
    EXPECT_NEAR(mean, expected, 4 * 0.033) << x;
  }
}

// Mean time of a pixel's samples: the middle of the exposure. The radiance of a passing wall is linear in X, so a pixel
// differs from the radiance at its centre by the mean errors of its times and places. 16 even times of each pixel have
// an error below a tenth of a part of the exposure, 0.6 mm here; times that are late in every part together have up to
// half a part, 3.1 mm. The places add 1/32 px, 0.45 mm.
TEST(Exposure, TheMomentsOfAPixelAreTogetherInTheMiddle) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-10, -9, 1}, {20, 0, 0}, {0, 18, 0}, 0);
  scene.meshes.back().colors = {glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(1.0f), glm::vec3(0.0f)};
  scene.lights = {AmbientLight{{1, 1, 1}}};
  const CameraParams params = SmallCamera(80, 60);
  const RadianceImage image =
      Expose(*MakeRayTracer(scene), SteadyMotion(Pose{}, {1, 0, 0}), Open(16, 0.1), 3, Camera(params));
  double worst = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      const double X = 20 * double{image.pixel(x, y)[0]} - 10;
      worst = std::max(worst, std::abs(X - (x - params.cx) / params.fx));
    }
  }
  EXPECT_LT(worst, 0.0011);
}

// Bright fraction of a pixel's area with the edge of a half plane at a known place: box filter. n points of the
// (0, 2)-sequence err by at most 1/n on a vertical edge.
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

// f A |1/Z - 1/F| / 2: radius of the blur disc at depth Z of a thin lens of diameter A focused at F. The bright part of
// a disc at x radii from an edge is 1/2 + (x sqrt(1 - x^2) + asin x) / pi.
TEST(Exposure, ALensBlursWhatIsOutOfFocusIntoDiscs) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
  constexpr double z = 4.0, aperture = 0.4;
  AddQuad(scene, {0.0f, -90, z}, {90, 0, 0}, {0, 180, 0}, 0);
  const Camera camera(SmallCamera(83, 40));  // the edge is at u = 41
  for (const double focus : {1.0, 2.0, 4.0, 1e6}) {
    Exposure exposure = Open(2048, 0.0);
    exposure.aperture_m = aperture;
    exposure.focus_m = focus;
    const RadianceImage image = Expose(*MakeRayTracer(scene), SteadyMotion(Pose{}), exposure, 3, camera);
    const double radius = 70 * aperture * std::abs(1 / z - 1 / focus) / 2;
    double worst = 0;
    for (int u = 0; u < 83; ++u) {
      double expected = 0;  // the mean over the pixel's width
      for (int i = 0; i < 200; ++i) {
        const double off = u - 41 + (i + 0.5) / 200 - 0.5, x = std::clamp(off / std::max(radius, 1e-9), -1.0, 1.0);
        expected += (0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / std::numbers::pi) / 200;
      }
      for (int v = 0; v < 40; ++v) worst = std::max(worst, std::abs(image.pixel(u, v)[0] - expected));
    }
    // The worst of 3000 pixels is below two standard deviations of independent points, 0.5 / sqrt(2048). A radius with
    // an error of a tenth gives 0.05.
    EXPECT_LT(worst, 0.022) << "focus " << focus << ", radius " << radius << " px";
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
  EXPECT_THROW(MakeRayTracer(Scene{})->Expose(Camera(SmallCamera()), SteadyMotion(Pose{}), Open(0), 1, image),
               std::invalid_argument);
  EXPECT_THROW(MakeRayTracer(Scene{})->Expose(Camera(SmallCamera()), SteadyMotion(Pose{}), Open(1, -1.0), 1, image),
               std::invalid_argument);
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
