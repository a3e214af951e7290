// Moving objects: closed forms, the same world at rest, exposures. For all renderers.
#include <gmock/gmock.h>

#include <thread>

#include "sim/render/placed_objects.h"
#include "sim/render/surface_tracer.h"
#include "tests/unit/sim/render/engines.h"
#include "tests/unit/sim/render/moving_worlds.h"

namespace sim::test {
namespace {

class Moving : public EngineTest {};
INSTANTIATE_TEST_SUITE_P(Engine, Moving, testing::Values(kRayTracer, kEgl, kOsmesa), EngineName);

double Rms(const RadianceImage& a, const RadianceImage& b, int first_row = 0, int last_row = -1) {
  double sum = 0;
  int count = 0;
  for (int y = first_row; y <= (last_row < 0 ? a.height - 1 : last_row); ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < 3; ++c) sum += std::pow(double{a.pixel(x, y)[c]} - b.pixel(x, y)[c], 2), ++count;
    }
  }
  return std::sqrt(sum / count);
}

RadianceImage Expose(const Renderer& renderer, const Camera& camera, const Trajectory& motion,
                     const Exposure& exposure) {
  RadianceImage image;
  renderer.Expose(camera, motion, exposure, 1, image);
  return image;
}

// fx v T / Z = 3.5 px: blur of each edge of an emitting bar of 0.2 m at Z = 2 m that moves at 1 m/s to the right for
// 0.1 s. A pixel's radiance is its coverage averaged over the exposure.
TEST_P(Moving, BlurOfABarIsItsWay) {
  const auto bar = [](double speed) {
    Scene scene;
    AddMaterial(scene, glm::vec3(0.0f), glm::vec3(1.0f));
    AddQuad(scene, {-0.1f, -9, 2}, {0.2f, 0, 0}, {0, 18, 0}, 0);
    MakeObject(scene, 0, std::make_shared<SteadyMotion>(Pose{}, glm::dvec3(speed, 0, 0)));
    return scene;
  };
  const CameraParams params = SmallCamera(83, 40);
  const Exposure exposure{0.02, 0.1, 0.0, 64};
  const auto covered = [&](int x, double speed) {  // midpoints of 20000 parts of the exposure
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const double t = exposure.middle_s + exposure.exposure_s * ((i + 0.5) / 20000 - 0.5);
      const double left = params.cx + params.fx * (speed * t - 0.1) / 2, right = left + params.fx * 0.2 / 2;
      sum += std::max(0.0, std::min(x + 0.5, right) - std::max(x - 0.5, left));
    }
    return sum / 20000;
  };
  const auto worst = [&](double speed) {
    RayTracerOptions options;
    options.jobs = 1;
    const RadianceImage image =
        Expose(*MakeEngine(GetParam(), bar(speed), options), Camera(params), SteadyMotion(Pose{}), exposure);
    double most = 0, length = 0;
    int first = params.width, last = 0;
    for (int x = 0; x < params.width; ++x) {
      double mean = 0;
      for (int y = 0; y < params.height; ++y) mean += double{image.pixel(x, y)[0]} / params.height;
      most = std::max(most, std::abs(mean - covered(x, 1.0)));
      length += mean;
      first = mean > 0 ? std::min(first, x) : first, last = mean > 0 ? std::max(last, x) : last;
    }
    EXPECT_NEAR(length, 0.2 * 35, 0.1) << "its light is what it is";
    // Extent of the blurred bar in pixels.
    const double left = params.cx + 35 * (speed * (0.02 - 0.05) - 0.1),
                 right = params.cx + 35 * (speed * (0.02 + 0.05) + 0.1);
    EXPECT_NEAR(last - first, std::floor(right + 0.5) - std::floor(left + 0.5), 1.0) << "the bar and its way";
    return most;
  };
  EXPECT_LT(worst(1.0), 1.0 / 64 + 1.0 / 256);
  EXPECT_GT(worst(0.85), 0.05) << "the control";
}

// Exchange of object and camera motion: in ambient light only the relative motion matters.
TEST_P(Moving, ObjectAndCameraChangePlaces) {
  Scene still = CarriedThings();
  still.lights = {AmbientLight{{1, 1, 1}}};
  still.meshes.insert(still.meshes.end(), still.objects[0].meshes.begin(), still.objects[0].meshes.end());
  still.objects.clear();
  Scene moving = still;
  MakeObject(moving, 0, Carried());
  const Pose camera_pose = TiltedPose();
  const SeenFrom relative(Carried(), camera_pose);
  const Camera camera(DistortedCamera());
  const auto a = MakeEngine(GetParam(), moving, {}), b = MakeEngine(GetParam(), still, {});
  for (const double t_s : {0.0, 0.3}) {
    if (GetParam().is_rasteriser) break;  // no traced depth
    const std::vector<float> depth_a = DepthOf(*a, camera, View(camera_pose, t_s)),
                             depth_b = DepthOf(*b, camera, relative.At(t_s).pose);
    int differ = 0;
    for (std::size_t i = 0; i < depth_a.size(); ++i) differ += std::abs(depth_a[i] - depth_b[i]) > 1e-6f * depth_a[i];
    EXPECT_LE(differ, 4) << "of " << depth_a.size() << ": edges";
  }
  for (const Exposure exposure :
       {Exposure{0.1, 0.0, 0.0, 1}, Exposure{0.1, 0.03, 0.0, 8}, Exposure{0.1, 0.01, 2e-4, 8}}) {
    const RadianceImage image = Expose(*a, camera, SteadyMotion(camera_pose), exposure),
                        same = Expose(*b, camera, relative, exposure);
    EXPECT_LT(Rms(image, same), 2e-3);
    Exposure late = exposure;
    late.middle_s += 0.003;
    EXPECT_GT(Rms(image, Expose(*b, camera, relative, late)), 1e-2) << "the control";
  }
}

// Shading of a moving object against a static world at its pose: lamps, shadows, normals, textures and vertex colours.
TEST_P(Moving, IsLitAsIfItStoodThere) {
  const Scene scene = CarriedThings();
  const auto moving = MakeEngine(GetParam(), scene);
  const Camera camera(SmallCamera());
  const SteadyMotion still(TiltedPose());
  for (const double t_s : {0.0, 0.25}) {
    const Exposure instant{t_s, 0.0, 0.0, 1};
    const RadianceImage image = Expose(*moving, camera, still, instant);
    EXPECT_LT(Rms(image, Expose(*MakeEngine(GetParam(), StoppedAt(scene, t_s)), camera, still, instant)), 2e-3);
    EXPECT_GT(Rms(image, Expose(*MakeEngine(GetParam(), StoppedAt(scene, t_s + 0.01)), camera, still, instant)), 1e-2);
  }
}

// Time of each ray and its shadow rays: a row of a rolling shutter shows the world at the middle of the row's exposure.
TEST(MovingRays, ARowSeesTheWorldAtItsMoment) {
  Scene scene = CarriedThings();
  Texture bumps("bumps", 2, 2, std::vector<std::uint8_t>{128, 128, 255, 200, 128, 220, 128, 200, 220, 60, 100, 220}, {},
                Texture::Content::numbers);
  scene.textures.push_back(bumps);
  scene.materials[1].normal_map = 1;
  const Camera camera(SmallCamera());
  const SteadyMotion motion(TiltedPose(), {0.2, 0.1, 0.1}, {0.1, -0.2, 0.3});
  const Exposure rolling{0.1, 0.0, 1e-3, 1};
  const RadianceImage image = Expose(*MakeRayTracer(scene, Centred()), camera, motion, rolling);
  for (const int y : {24, 30, 38}) {
    const double t_s = rolling.RowMiddle(y, camera.height());
    const Exposure instant{t_s, 0.0, 0.0, 1};
    EXPECT_LT(Rms(image, Expose(*MakeRayTracer(StoppedAt(scene, t_s), Centred()), camera, motion, instant), y, y),
              3e-3);
    EXPECT_GT(
        Rms(image, Expose(*MakeRayTracer(StoppedAt(scene, t_s + 0.01), Centred()), camera, motion, instant), y, y),
        1e-2);
  }
}

// Embree's interpolated pose against the exact one: 1 m/s and 2 rad/s over 35 ms, at a corner of a cube of 1 m.
TEST(MovingRays, PathsAreFollowedClosely) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddBox(scene, glm::vec3(-0.5f), glm::vec3(0.5f), 0);
  const auto path = std::make_shared<SteadyMotion>(Pose{{1, 2, 3}}, glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 2, 0));
  MakeObject(scene, 0, path);
  const RayScene rays(scene);
  const PlacedObjects placed(rays, 1.0, 1.035);
  const glm::dvec3 X_O(0.5, 0.5, -0.5);
  double worst = 0, straight = 0;
  const auto exact = [&](double t_s) { return path->At(t_s).pose.q_WC * X_O + path->At(t_s).pose.p_WC; };
  for (int i = 0; i <= 1000; ++i) {
    const double t_s = 1.0 + 0.035 * i / 1000;
    float m[12];
    rtcGetGeometryTransform(rtcGetGeometry(placed.embree(), 0), static_cast<float>(placed.TimeOf(t_s)),
                            RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
    glm::dvec3 X_W(m[9], m[10], m[11]);
    for (int c = 0; c < 3; ++c) X_W += X_O[c] * glm::dvec3(m[3 * c], m[3 * c + 1], m[3 * c + 2]);
    worst = std::max(worst, glm::length(X_W - exact(t_s)));
    straight = std::max(straight, glm::length(glm::mix(exact(1.0), exact(1.035), i / 1000.0) - exact(t_s)));
  }
  EXPECT_LT(worst, 2e-6);     // 1e-6 and the rounding of floats at 4 m; required: 1e-5
  EXPECT_GT(straight, 1e-4);  // the control: one straight piece
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("steps", placed.packet().steps);
  EXPECT_EQ(PlacedObjects(rays, 1.0, 1.0).packet().steps, 1);
}

TEST(MovingRays, TheSameBytesFromAnyThreads) {
  const Scene scene = CarriedThings();
  const Camera camera(SmallCamera());
  const SteadyMotion motion(TiltedPose(), {0.2, 0.1, 0.1});
  RayTracerOptions one, two;
  one.jobs = 1, two.jobs = 2;
  const auto a = MakeRayTracer(scene, one), b = MakeRayTracer(scene, two);
  const Exposure blur{0.1, 0.02, 1e-4, 4}, later{0.3, 0.01, 0.0, 4};
  const RadianceImage first = Expose(*a, camera, motion, blur), second = Expose(*a, camera, motion, later);
  RadianceImage c, d;
  std::vector<SurfacePoint> points, same;
  a->surfaces()->Trace(camera, View(TiltedPose(), 0.2), same);
  std::thread x([&] {
    for (int i = 0; i < 5; ++i) c = Expose(*b, camera, motion, blur);
  });
  std::thread y([&] {
    for (int i = 0; i < 5; ++i) d = Expose(*b, camera, motion, later);
  });
  for (int i = 0; i < 5; ++i) b->surfaces()->Trace(camera, View(TiltedPose(), 0.2), points);
  x.join(), y.join();
  EXPECT_EQ(first.rgb, c.rgb);
  EXPECT_EQ(second.rgb, d.rgb);
  for (std::size_t i = 0; i < same.size(); ++i) ASSERT_EQ(points[i].X_C, same[i].X_C);
}

// Moving objects in a world with baked light: lamps and ambient light as in `direct`. Baked surfaces have no ambient
// light.
TEST(MovingRays, AreLitWhereLightIsBaked) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.5f));
  AddQuad(scene, {-3, 1, 0}, {6, 0, 0}, {0, 0, 6}, 0);  // y is down here
  AddQuad(scene, {-0.5f, -0.5f, 2}, {1, 0, 0}, {0, 1, 0}, 0);
  MakeObject(scene, 1, std::make_shared<SteadyMotion>(Pose{}));
  scene.lights = {AmbientLight{{0.2, 0.3, 0.4}}, PointLight{{0.2, -0.4, 0}, {4, 4, 4}}};
  const Camera camera(SmallCamera());
  std::vector<SurfacePoint> points;
  MakeRayTracer(scene)->surfaces()->Trace(camera, Pose{}, points);
  const RadianceImage direct = Render(scene, camera, Pose{});
  for (const LightMode mode : {LightMode::baked_indirect, LightMode::baked}) {
    const BakeParams bake{0.5, 0.25, 16, 16};
    const RadianceImage image = Render(*MakeBaked(scene, mode, bake), camera, Pose{});
    EXPECT_THAT(BakeWarnings(scene, RayScene(scene), mode, bake),
                testing::Contains(testing::StartsWith("moving objects are not in baked light: lamps shine on them")));
    int on_object = 0;
    double floor = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].triangle == kNoTriangle) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const float seen = image.rgb[3 * i + c], expected = direct.rgb[3 * i + c];
        if (points[i].object == kWorld) {
          floor = std::max(floor, std::abs(double{seen} - expected));
        } else {
          ASSERT_FLOAT_EQ(seen, expected) << i;
        }
      }
      on_object += points[i].object == 0;
    }
    EXPECT_GT(on_object, 500);
    EXPECT_GT(floor, 0.05) << "the floor has no ambient light";
  }
}

TEST(MovingRays, AnObjectWithoutMotionIsRefused) {
  Scene scene = CarriedThings();
  scene.objects[0].motion.reset();
  EXPECT_THROW(MakeRayTracer(scene), std::invalid_argument);
}

}  // namespace
}  // namespace sim::test
