// Specular reflection: mirrors against the mirrored world, lobes against quadrature over the hemisphere, energy in a
// furnace.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

RayTracerOptions Mirroring(int rays) {
  RayTracerOptions options = Centred();
  options.jitter = rays > 1;
  options.rays_per_time_sample = rays;
  options.reflections = true;
  return options;
}

int AddGlossy(Scene& scene, glm::vec3 base_color, float metallic, float roughness) {
  const int index = AddMaterial(scene, base_color);
  scene.materials.back().metallic = metallic;
  scene.materials.back().roughness = roughness;
  return index;
}

glm::dvec3 Mean(const RadianceImage& image) {
  glm::dvec3 sum(0.0);
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      sum += glm::dvec3(image.pixel(u, v)[0], image.pixel(u, v)[1], image.pixel(u, v)[2]);
  return sum / static_cast<double>(image.width * image.height);
}

// Image in a mirror that fills the view, in the plane z = 3: that of a camera behind the mirror with left and right
// exchanged, times the metal's Fresnel reflectance.
TEST(Reflection, AFlatMirrorShowsTheMirroredWorld) {
  Scene behind;
  const int red = AddMaterial(behind, {0.8f, 0.1f, 0.1f}), blue = AddMaterial(behind, {0.1f, 0.2f, 0.9f}),
            grey = AddMaterial(behind, {0.5f, 0.5f, 0.5f});
  AddQuad(behind, {-30, -30, -9}, {60, 0, 0}, {0, 60, 0}, grey);
  AddBox(behind, {-1.5f, -0.7f, -4.5f}, {-0.3f, 0.6f, -3.5f}, red);
  AddSphere(behind, {1.1, 0.3, -4.0}, 0.7, 24, blue);
  behind.lights.push_back(AmbientLight{glm::dvec3(0.2)});
  behind.lights.push_back(SunLight{{0.2, 1, -0.05}, {2, 1.8, 1.5}});  // does not reach the mirror: no highlight on it
  Scene scene = behind;
  AddQuad(scene, {-40, -40, 3}, {80, 0, 0}, {0, 80, 0}, AddGlossy(scene, {0.9f, 0.6f, 0.3f}, 1, 0));

  CameraParams params = SmallCamera();
  params.cx = 41;  // pixels have mirror images
  const Camera camera(params);
  const RadianceImage seen = Render(scene, camera, Pose{}, Mirroring(1));
  // The mirrored camera at (0, 0, 6) looks along -z; its orientation is a half turn about y, without the reflection.
  const RadianceImage expected = Render(behind, camera, Pose{{0, 0, 6}, glm::dquat(0, 0, 1, 0)}, Mirroring(1));
  int compared = 0, off = 0;
  for (int v = 1; v + 1 < camera.height(); ++v) {
    for (int u = 1; u + 1 < camera.width(); ++u) {
      const int m = 82 - u;
      const double x = (u - params.cx) / params.fx, y = (v - params.cy) / params.fy;
      const double fresnel = std::pow(1 - 1 / std::sqrt(1 + x * x + y * y), 5);
      for (int c = 0; c < 3; ++c) {
        float low = 1e9f, high = 0;
        for (const int i : {-1, 0, 1}) {
          for (const int j : {-1, 0, 1}) {
            low = std::min(low, expected.pixel(m + i, v + j)[c]);
            high = std::max(high, expected.pixel(m + i, v + j)[c]);
          }
        }
        if (high > 1.05f * low) continue;  // an edge, where rounding decides the hit
        const double f0 = std::array{0.9, 0.6, 0.3}[static_cast<std::size_t>(c)];
        const double want = (f0 + (1 - f0) * fresnel) * expected.pixel(m, v)[c];
        ++compared;
        off += std::abs(seen.pixel(u, v)[c] - want) > 1e-3 * want;
      }
    }
  }
  EXPECT_EQ(off, 0) << "of " << compared;
  EXPECT_GT(compared, 3 * 81 * 59 * 3 / 4);
  const RadianceImage lambert = Render(scene, camera, Pose{});
  EXPECT_GT(std::abs(Mean(lambert).x - Mean(seen).x), 0.05) << "without reflections it is another picture";
}

// D G2 / (4 n.v), GGX, from the definitions of D and G2 in another form than the renderer's.
double MicrofacetTimesCosine(const glm::dvec3& n, const glm::dvec3& v, const glm::dvec3& l, double alpha) {
  const glm::dvec3 h = glm::normalize(v + l);
  const auto lambda = [&](const glm::dvec3& w) {
    const double c = glm::dot(n, w), tan2 = (1 - c * c) / (c * c);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
  };
  const double c = glm::dot(n, h), d = c * c * (alpha * alpha - 1) + 1;
  const double D = alpha * alpha / (std::numbers::pi * d * d), G2 = 1 / (1 + lambda(v) + lambda(l));
  return D * G2 / (4 * glm::dot(n, v));
}

// Directional albedo of the specular lobe: a metal of base colour 1 under a sky of radiance 1, against quadrature over
// the hemisphere; 1 for a mirror. 4096 rays of a small image: a standard error of 2e-4 or less.
TEST(Reflection, MetalUnderAWhiteSky) {
  for (const double roughness : {0.0, 0.3, 0.6, 1.0}) {
    for (const double angle : {0.2, 1.0, 1.35}) {
      Scene scene;
      scene.background = glm::vec3(1.0f);
      const glm::dvec3 n(0, 0, -1), v(std::sin(angle), 0, -std::cos(angle));
      AddQuad(scene, {-400, -400, 3}, {800, 0, 0}, {0, 800, 0},
              AddGlossy(scene, glm::vec3(1.0f), 1, static_cast<float>(roughness)));
      CameraParams params = SmallCamera(8, 8);
      params.fx = params.fy = 4000;  // all rays have nearly one direction
      params.cx = params.cy = 3.5;
      const glm::dquat towards = glm::angleAxis(-angle, glm::dvec3(0, 1, 0));
      const glm::dvec3 seen = Mean(Render(scene, Camera(params), Pose{{0, 0, 0}, towards}, Mirroring(64)));
      const double alpha = std::max(roughness * roughness, 1e-3);
      double expected = 1;
      if (roughness > 0) {
        // Over normals h: dl = 4 (v.h) dh, which resolves narrow lobes too.
        expected = 0;
        const int rows = 2000, columns = 720;
        for (int i = 0; i < rows; ++i) {
          const double u = (i + 0.5) / rows, tan2 = alpha * alpha * u / (1 - u), z = 1 / std::sqrt(1 + tan2);
          for (int j = 0; j < columns; ++j) {
            const double phi = 2 * std::numbers::pi * (j + 0.5) / columns, s = std::sqrt(1 - z * z);
            const glm::dvec3 h(s * std::cos(phi), s * std::sin(phi), -z), l = 2 * glm::dot(v, h) * h - v;
            if (glm::dot(v, h) <= 0 || glm::dot(l, n) <= 0) continue;
            const double d = z * z * (alpha * alpha - 1) + 1, D = alpha * alpha / (std::numbers::pi * d * d);
            expected += MicrofacetTimesCosine(n, v, l, alpha) * 4 * glm::dot(v, h) / (D * z) / (rows * columns);
          }
        }
      }
      EXPECT_NEAR(seen.x, expected, 2e-3) << roughness << ", " << angle;
      EXPECT_LE(seen.x, 1.001);
      EXPECT_EQ(seen.x, seen.y);
    }
  }
}

// F = 0.04 + 0.96 (1 - cos)^5 is reflected by a dielectric's mirror, 1 - F by its Lambertian base: at most the incident
// light.
TEST(Reflection, PaintKeepsItsEnergy) {
  for (const double angle : {0.1, 0.8, 1.3}) {
    Scene scene;
    scene.background = glm::vec3(1.0f);
    scene.lights.push_back(AmbientLight{glm::dvec3(1.0)});
    AddQuad(scene, {-400, -400, 3}, {800, 0, 0}, {0, 800, 0}, AddGlossy(scene, {1.0f, 0.5f, 0.0f}, 0, 0));
    CameraParams params = SmallCamera(8, 8);
    params.fx = params.fy = 4000;
    params.cx = params.cy = 3.5;
    const glm::dvec3 seen = Mean(
        Render(scene, Camera(params), Pose{{0, 0, 0}, glm::angleAxis(-angle, glm::dvec3(0, 1, 0))}, Mirroring(16)));
    const double fresnel = 0.04 + 0.96 * std::pow(1 - std::cos(angle), 5);
    EXPECT_NEAR(seen.x, 1, 2e-3) << angle;
    EXPECT_NEAR(seen.y, fresnel + 0.5 * (1 - fresnel), 2e-3) << angle;
    EXPECT_NEAR(seen.z, fresnel, 2e-3) << angle;
  }
}

// Highlight of a point light on a metal plane, pixel by pixel, from the definitions.
TEST(Reflection, APointLightsHighlight) {
  for (const double roughness : {0.25, 0.5, 0.8}) {
    Scene scene;
    AddQuad(scene, {-40, -40, 3}, {80, 0, 0}, {0, 80, 0},
            AddGlossy(scene, {0.5f, 0.7f, 0.9f}, 1, static_cast<float>(roughness)));
    const PointLight light{{0.4, -0.3, 1.0}, {3, 2, 1}};
    scene.lights.push_back(light);
    const Camera camera(SmallCamera());
    const RadianceImage seen = Render(scene, camera, Pose{}, Mirroring(1));
    double worst = 0;
    for (int v = 0; v < camera.height(); ++v) {
      for (int u = 0; u < camera.width(); ++u) {
        const glm::dvec3 ray = RayInWorld(camera, Pose{}, u, v), x = ray * (3.0 / ray.z), to_light = light.position - x,
                         n(0, 0, -1);
        const glm::dvec3 view = glm::normalize(-x), l = glm::normalize(to_light), h = glm::normalize(view + l);
        const double r2 = glm::dot(to_light, to_light), fresnel = std::pow(1 - glm::dot(view, h), 5);
        for (int c = 0; c < 3; ++c) {
          const double f0 = std::array{0.5, 0.7, 0.9}[static_cast<std::size_t>(c)];
          const double want = (f0 + (1 - f0) * fresnel) * MicrofacetTimesCosine(n, view, l, roughness * roughness) *
                              light.intensity[c] / r2;
          worst = std::max(worst, std::abs(seen.pixel(u, v)[c] - want) / (want + 1e-4));
        }
      }
    }
    EXPECT_LT(worst, 1e-3) << roughness;
  }
}

// Area light in a mirror and in a rough metal: equal to an emitting quad of the same radiance, and one-sided.
TEST(Reflection, AnAreaLampIsSeenInWhatMirrors) {
  const RectLight lamp{{-0.5, -0.4, 1.0}, {0, 0.8, 0}, {1, 0, 0}, {4, 3, 2}};
  for (const float roughness : {0.0f, 0.5f}) {
    Scene lit, glowing;
    for (Scene* scene : {&lit, &glowing})
      AddQuad(*scene, {-40, -40, 3}, {80, 0, 0}, {0, 80, 0}, AddGlossy(*scene, glm::vec3(1.0f), 1, roughness));
    RectLight facing = lamp;
    if (glm::cross(lamp.side_u, lamp.side_v).z < 0) std::swap(facing.side_u, facing.side_v);
    lit.lights.push_back(facing);
    AddQuad(glowing, glm::vec3(lamp.corner), glm::vec3(lamp.side_u), glm::vec3(lamp.side_v),
            AddMaterial(glowing, glm::vec3(0.0f), glm::vec3(lamp.radiance)));
    // From the side, with the emitting quad itself out of view.
    CameraParams params = SmallCamera();
    params.fx = params.fy = 120;
    const Camera camera(params);
    const Pose pose{{2.5, 0, 0}, glm::angleAxis(-0.46, glm::dvec3(0, 1, 0))};
    const glm::dvec3 a = Mean(Render(lit, camera, pose, Mirroring(256))),
                     b = Mean(Render(glowing, camera, pose, Mirroring(256)));
    EXPECT_GT(a.x, 0.02);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, 0.01) << roughness;
    RectLight away = facing;
    std::swap(away.side_u, away.side_v);
    lit.lights = {away};
    EXPECT_EQ(Mean(Render(lit, camera, pose, Mirroring(4))).x, 0);
  }
}

TEST(Reflection, BytesDoNotDependOnThreads) {
  Scene scene = BusyWorld();
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.3f;
  RayTracerOptions one = Mirroring(4), two = one;
  two.jobs = 2;
  const Camera camera(SmallCamera());
  EXPECT_EQ(Render(scene, camera, TiltedPose(), one).rgb, Render(scene, camera, TiltedPose(), two).rgb);
}

}  // namespace
}  // namespace sim::test
