// Radiance in closed form, by every renderer: plane under each kind of light, white furnace, shadow boundary.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/sim/render/engines.h"

namespace sim::test {
namespace {

const glm::vec3 kAlbedo(0.8f, 0.4f, 0.1f);

// A large plane through `at` with unit normal n, seen from the side of n.
Scene PlaneWorld(glm::dvec3 at, glm::dvec3 n) {
  Scene scene;
  AddMaterial(scene, kAlbedo);
  const glm::dvec3 a = glm::normalize(glm::cross(n, glm::dvec3(0.3, 1, 0.2))), b = glm::cross(n, a);
  AddQuad(scene, glm::vec3(at - 40.0 * a - 40.0 * b), glm::vec3(80.0 * a), glm::vec3(80.0 * b), 0);
  return scene;
}

class Light : public EngineTest {
 protected:
  // Compares every pixel with irradiance(X_W) * albedo / pi.
  template <class Irradiance>
  void ExpectPlane(const Scene& scene, glm::dvec3 at, glm::dvec3 n, double relative,
                   const Irradiance& irradiance) const {
    const Camera camera(DistortedCamera());
    const Pose pose = TiltedPose();
    const RadianceImage image = Render(scene, camera, pose);
    double worst = 0;
    for (int v = 0; v < camera.height(); ++v) {
      for (int u = 0; u < camera.width(); ++u) {
        const glm::dvec3 ray = RayInWorld(camera, pose, u, v);
        const glm::dvec3 x = pose.p_WC + ray * (glm::dot(n, at - pose.p_WC) / glm::dot(n, ray));
        const glm::dvec3 expected = glm::dvec3(kAlbedo) * irradiance(x) / std::numbers::pi;
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(image.pixel(u, v)[c] / expected[c] - 1.0));
      }
    }
    EXPECT_LT(worst, relative);
  }

  // Bound on the error of shadows: `map` for a shadow map of finite resolution, `exact` for the ray tracer.
  double ShadowError(double map, double exact) const { return GetParam().is_rasteriser ? map : exact; }
};

INSTANTIATE_TEST_SUITE_P(Engine, Light, testing::Values(kRayTracer, kEgl, kOsmesa), EngineName);

TEST_P(Light, PointLightOnPlane) {
  const glm::dvec3 at(0, 0, 3), n = glm::normalize(glm::dvec3(0.2, -0.3, -1.0));
  Scene scene = PlaneWorld(at, n);
  const PointLight light{{0.7, -1.1, 1.0}, {5.0, 4.0, 3.0}};
  scene.lights.push_back(light);
  const auto irradiance = [&](glm::dvec3 x) {
    const glm::dvec3 l = light.position - x;
    const double r = glm::length(l);
    return light.intensity * glm::dot(n, l) / (r * r * r);
  };
  // Error of the lens table: 0.003 px, here 1e-4 m in x and 1e-4 in the light. A lens without distortion: below.
  ExpectPlane(scene, at, n, 3e-4, irradiance);

  const Camera camera(SmallCamera());
  const Pose pose = TiltedPose();
  const RadianceImage image = Render(scene, camera, pose);
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      const glm::dvec3 ray = RayInWorld(camera, pose, u, v);
      const glm::dvec3 x = pose.p_WC + ray * (glm::dot(n, at - pose.p_WC) / glm::dot(n, ray));
      const glm::dvec3 expected = glm::dvec3(kAlbedo) * irradiance(x) / std::numbers::pi;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.pixel(u, v)[c] / expected[c], 1.0, 1e-5) << u << ", " << v;
    }
  }
}

TEST_P(Light, SunOnPlane) {
  const glm::dvec3 at(0, 0, 3), n = glm::normalize(glm::dvec3(0.2, -0.3, -1.0));
  Scene scene = PlaneWorld(at, n);
  const SunLight sun{{0.5, 1.0, 2.0}, {2.0, 1.5, 1.0}};  // of any length
  scene.lights.push_back(sun);
  const double cosine = -glm::dot(n, glm::normalize(sun.direction));
  ExpectPlane(scene, at, n, 1e-5, [&](glm::dvec3) { return sun.irradiance * cosine; });
}

TEST_P(Light, AmbientAndEmissionAdd) {
  const glm::dvec3 at(0, 0, 3), n(0, 0, -1);
  Scene scene = PlaneWorld(at, n);
  scene.materials[0].emission = {0.25f, 0.5f, 0.75f};
  scene.lights.push_back(AmbientLight{{0.5, 0.25, 1.0}});
  scene.lights.push_back(AmbientLight{{0.5, 0.25, 1.0}});
  const RadianceImage image = Render(scene, Camera(SmallCamera()), Pose{});
  EXPECT_FLOAT_EQ(image.pixel(5, 7)[0], 0.25f + 0.8f * 1.0f);
  EXPECT_FLOAT_EQ(image.pixel(5, 7)[1], 0.5f + 0.4f * 0.5f);
  EXPECT_FLOAT_EQ(image.pixel(5, 7)[2], 0.75f + 0.1f * 2.0f);
}

TEST_P(Light, NoneFromBehindTheSurface) {
  const glm::dvec3 at(0, 0, 3), n(0, 0, -1);
  for (const sim::Light& light :
       {sim::Light(PointLight{{0, 0, 5}, {9, 9, 9}}), sim::Light(SunLight{{0, 0, -1}, {9, 9, 9}}),
        sim::Light(RectLight{{0, 0, 5}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}})}) {
    Scene scene = PlaneWorld(at, n);
    scene.lights.push_back(light);
    const RadianceImage image = Render(scene, Camera(SmallCamera()), Pose{});
    EXPECT_THAT(image.rgb, testing::Each(0.0f));
  }
}

TEST_P(Light, RectLightOnPlaneAgainstLambertsFormula) {
  const glm::dvec3 at(0, 0, 3), n(0, 0, -1);
  Scene scene = PlaneWorld(at, n);
  // Shines towards cross(side_u, side_v) = +z, on the plane.
  const RectLight light{{-0.5, -0.4, 1.0}, {1.2, 0, 0}, {0, 0.7, 0}, {3, 2, 1}};
  scene.lights.push_back(light);
  RayTracerOptions options = Centred();
  options.rays_per_time_sample = 1024;  // samples on the light, all through the pixel's centre
  const Camera camera(SmallCamera(16, 12));
  const RadianceImage image = Render(scene, camera, Pose{}, options);
  const std::vector<glm::dvec3> corners = {light.corner, light.corner + light.side_u,
                                           light.corner + light.side_u + light.side_v, light.corner + light.side_v};
  for (int v = 0; v < 12; ++v) {
    for (int u = 0; u < 16; ++u) {
      const glm::dvec3 x = 3.0 * RayInWorld(camera, Pose{}, u, v);
      const double expected = 0.8 / std::numbers::pi * 3.0 * PolygonIrradiance(corners, x, n);
      ASSERT_NEAR(image.pixel(u, v)[0] / expected, 1.0, 1e-3)
          << u << ", " << v;  // 1024 points: smooth integrand, 1/1024 a side
    }
  }
}

// Mean of the sample points on an area light: its middle, for any number of samples. The light of a lamp that stands
// upright on the wall grows with the height of the sample point.
TEST_P(Light, RectLightIsCentredWithAnyNumberOfRays) {
  const glm::dvec3 n(0, 0, -1);
  Scene scene = PlaneWorld({0, 0, 3}, n);
  const RectLight light{{-10, -0.5, 2.5}, {0, 0, -1}, {0, 1, 0}, {300, 300, 300}};  // shines towards +x
  scene.lights.push_back(light);
  const std::vector<glm::dvec3> corners = {light.corner, light.corner + light.side_u,
                                           light.corner + light.side_u + light.side_v, light.corner + light.side_v};
  const Camera camera(SmallCamera(1, 1));  // its only pixel looks along z
  const double expected = 0.8 / std::numbers::pi * 300 * PolygonIrradiance(corners, {0, 0, 3}, n);
  for (const int rays : {2, 3, 5, 8, 12, 24}) {
    RayTracerOptions options = Centred();
    options.rays_per_time_sample = rays;
    EXPECT_NEAR(Render(scene, camera, Pose{}, options).pixel(0, 0)[0] / expected, 1.0, 4e-3) << rays;
  }
}

TEST_P(Light, RectLightIsDarkBehind) {
  Scene scene = PlaneWorld({0, 0, 3}, {0, 0, -1});
  scene.lights.push_back(RectLight{{-0.5, -0.4, 1.0}, {0, 0.7, 0}, {1.2, 0, 0}, {3, 2, 1}});  // shines towards -z
  EXPECT_THAT(Render(scene, Camera(SmallCamera()), Pose{}).rgb, testing::Each(0.0f));
}

TEST_P(Light, WhiteFurnace) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddBox(scene, {-1, -2, -3}, {2, 2, 3}, 0);
  AddSphere(scene, {0.4, 0.3, 1.5}, 0.5, 12, 0);
  scene.lights.push_back(AmbientLight{{1, 1, 1}});
  scene.background = glm::vec3(100.0f);  // radiance of a ray that leaks between two triangles
  RayTracerOptions options;
  options.rays_per_time_sample = 16;
  const Camera camera(SmallCamera(160, 120));
  EXPECT_THAT(Render(scene, camera, TiltedPose(), options).rgb, testing::Each(testing::FloatNear(1.0f, 1e-6f)));
  // Control: a box with a hole shows the background.
  scene.meshes[3].triangles.pop_back();
  EXPECT_THAT(Render(scene, camera, TiltedPose(), options).rgb, testing::Contains(testing::Gt(50.0f)));
}

TEST_P(Light, SmoothNormalsOfASphere) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  const glm::dvec3 center(0.1, -0.2, 4.0);
  const int rings = 200;
  AddSphere(scene, center, 1.0, rings, 0);
  scene.lights.push_back(SunLight{{0.2, 0.3, 1.0}, glm::dvec3(std::numbers::pi)});
  const glm::dvec3 towards = -glm::normalize(glm::dvec3(0.2, 0.3, 1.0));
  const Camera camera(SmallCamera());
  const RadianceImage image = Render(scene, camera, Pose{});
  int seen = 0;
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      const glm::dvec3 d = glm::normalize(RayInWorld(camera, Pose{}, u, v));
      const double along = glm::dot(d, center), miss = std::sqrt(glm::dot(center, center) - along * along);
      if (miss > 0.9) continue;  // the rim, where the facets' error is magnified
      const glm::dvec3 n = glm::normalize(d * (along - std::sqrt(1 - miss * miss)) - center);
      const double cosine = glm::dot(n, towards);
      if (cosine < 0.05) continue;
      ++seen;
      // The facets lie up to 1 - cos(pi / (2 rings)) = 3e-5 inside, along rays that meet them at 25 degrees or more.
      ASSERT_NEAR(image.pixel(u, v)[0], cosine, 3e-4) << u << ", " << v;
    }
  }
  EXPECT_GT(seen, 200);
}

// A half plane at z = 2 (x < 0.5) between a point light and the plane z = 3: the boundary of its shadow is a straight
// line.
TEST_P(Light, ShadowBoundary) {
  Scene scene = PlaneWorld({0, 0, 3}, {0, 0, -1});
  const double edge = 0.5, light_x = 1.0;
  AddMaterial(scene, glm::vec3(0.0f));
  AddQuad(scene, {-20.0f, -20.0f, 2.0f}, {20.0f + static_cast<float>(edge), 0, 0}, {0, 40, 0}, 1);
  scene.lights.push_back(PointLight{{light_x, 0.1, 1.0}, {5, 5, 5}});
  const double boundary = light_x + (edge - light_x) * 2.0;  // similar triangles: at z = 3, twice as far from the light
  const Pose pose{{1.5, 0.0, 2.2}, {1, 0, 0, 0}};            // behind the half plane, looking at the plane
  const Camera camera(SmallCamera(400, 40));
  const RadianceImage image = Render(scene, camera, pose);
  int lit = 0, dark = 0;
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      const double x = 1.5 + 0.8 * RayInWorld(camera, pose, u, v).x;
      // A pixel and a texel of the shadow map at 3 m from the light are 0.011 m wide; the map's error is two texels.
      if (std::abs(x - boundary) < ShadowError(0.02, 1e-4)) continue;
      const bool is_lit = image.pixel(u, v)[0] > 0;
      (is_lit ? lit : dark) += 1;
      ASSERT_EQ(is_lit, x > boundary) << u << ", " << v << ": x = " << x;
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 1000);
}

// Half of the irradiance at the point from which half of the light is occluded.
TEST_P(Light, PenumbraOfRectLight) {
  Scene scene = PlaneWorld({0, 0, 3}, {0, 0, -1});
  AddMaterial(scene, glm::vec3(0.0f));
  AddQuad(scene, {-20, -20, 2}, {20, 0, 0}, {0, 40, 0}, 1);  // x < 0, halfway to the light at z = 1, -0.2 < x < 0.2
  scene.lights.push_back(RectLight{{-0.2, -0.2, 1}, {0.4, 0, 0}, {0, 0.4, 0}, {1, 1, 1}});
  RayTracerOptions options = Centred();
  options.rays_per_time_sample = 256;
  const Camera camera(SmallCamera(81, 1));  // its middle pixel looks along z
  const Pose pose{{0.0, 0.0, 2.5}, {1, 0, 0, 0}};
  const float half = Render(scene, camera, pose, options).pixel(40, 0)[0];
  scene.meshes.pop_back();
  const float whole = Render(scene, camera, pose, options).pixel(40, 0)[0];
  // The penumbra is 0.4 m wide, and a texel of a shadow map 0.004 m.
  EXPECT_NEAR(half / whole, 0.5, ShadowError(0.03, 1.0 / 256));
}

}  // namespace
}  // namespace sim::test
