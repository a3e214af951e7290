// The path tracer against closed forms. Bounds are four standard deviations of the estimate (false-alarm rate 1 in
// 16 000). Controls: a missing cosine and a missing albedo are rejected.
#include "sim/light/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Estimate {
  glm::dvec3 mean{0.0}, sigma{0.0};  // sigma: standard deviation of the mean
};

// The mean over `runs` independent estimates of `paths` paths each.
Estimate Indirect(const Scene& scene, const LightPoint& point, int paths, int runs) {
  const RayScene rays(scene);
  const PathTracer tracer(scene, rays);
  glm::dvec3 sum(0.0), squares(0.0);
  for (int i = 0; i < runs; ++i) {
    glm::dvec3 light(0.0);
    tracer.AddIndirect(point, 1000u + static_cast<std::uint64_t>(i), paths, std::span(&light, 1));
    sum += light;
    squares += light * light;
  }
  Estimate e;
  e.mean = sum / static_cast<double>(runs);
  e.sigma = glm::sqrt(glm::max(glm::dvec3(0.0), squares / static_cast<double>(runs) - e.mean * e.mean) / (runs - 1.0));
  return e;
}

glm::dvec3 Direct(const Scene& scene, const LightPoint& point, int samples = 1024) {
  const RayScene rays(scene);
  const PathTracer tracer(scene, rays);
  glm::dvec3 light(0.0);
  tracer.AddDirect(point, 7, samples, std::span(&light, 1));
  return light;
}

LightPoint Floor(glm::dvec3 at = {0.1, 0.0, -0.2}) { return {at, {0, 1, 0}, {0, 1, 0}}; }

// A floor at y = 0, seen from above.
Scene FloorWorld(glm::vec3 albedo) {
  Scene scene;
  AddMaterial(scene, albedo);
  AddQuad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, 0);
  return scene;
}

// L = e + a e + a^2 e + ... = e / (1 - a) everywhere in a closed box of emission e and albedo a.
TEST(PathTracer, WhiteFurnace) {
  Scene scene;
  const glm::dvec3 albedo(0.7, 0.5, 0.2), emission(0.3, 1.0, 2.0);
  AddMaterial(scene, glm::vec3(albedo), glm::vec3(emission));
  AddBox(scene, {-1, 0, -3}, {2, 2, 3}, 0);
  AddSphere(scene, {0.9, 0.8, 1.5}, 0.5, 12, 0);
  scene.background = glm::vec3(100.0f);  // radiance of a path that leaks out
  const Estimate e = Indirect(scene, Floor(), 256, 64);
  const glm::dvec3 expected = emission / (1.0 - albedo);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(e.sigma[c], 0.02 * expected[c]);
    EXPECT_NEAR(e.mean[c], expected[c], 4 * e.sigma[c]) << c;
    EXPECT_GT(std::abs(e.mean[c] - emission[c] / (1 - albedo[c] * albedo[c])), 4 * e.sigma[c])
        << "an albedo too many must show";
    EXPECT_GT(std::abs(e.mean[c] - emission[c]), 4 * e.sigma[c]) << "an albedo forgotten must show";
  }
}

TEST(PathTracer, UniformSkyIsExact) {
  Scene scene = FloorWorld(glm::vec3(0.5f));
  scene.sky = Sky{{2, 3, 4}, {2, 3, 4}, {2, 3, 4}, 0, 0, {}, 0.0};
  const Estimate e = Indirect(scene, Floor(), 16, 4);  // zero variance
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(e.mean[c], 2.0 + c, 1e-12);
}

// E / pi = integral of (h + (z - h) cos) cos / pi over the hemisphere = h + 2/3 (z - h). Without the cosine (directions
// uniform over the hemisphere) it would be h + (z - h) / 2.
TEST(PathTracer, GradientSky) {
  Scene scene = FloorWorld(glm::vec3(0.5f));
  scene.sky = Sky{{4, 1, 0}, {1, 2, 1}, {9, 9, 9}, 0, 0, {}, 0.0};
  const Estimate e = Indirect(scene, Floor(), 256, 16);
  for (int c = 0; c < 3; ++c) {
    const double z = (*scene.sky).zenith[c], h = (*scene.sky).horizon[c];
    EXPECT_LT(e.sigma[c], 2e-3);
    EXPECT_NEAR(e.mean[c], h + 2.0 / 3.0 * (z - h), 4 * e.sigma[c] + 1e-9) << c;
    EXPECT_GT(std::abs(e.mean[c] - (h + (z - h) / 2)), 4 * e.sigma[c]) << "the cosine left out must show";
  }
}

TEST(PathTracer, LampsOnAFloor) {
  const LightPoint at = Floor();
  Scene scene = FloorWorld(glm::vec3(0.5f));
  scene.lights = {SunLight{{1, -2, 0.5}, {3, 2, 1}}};
  const double cosine = 2 / std::sqrt(1 + 4 + 0.25);
  EXPECT_NEAR(Direct(scene, at).x, 3 * cosine / kPi, 1e-12);
  scene.lights = {SunLight{{1, 2, 0.5}, {3, 2, 1}}};  // from below
  EXPECT_EQ(Direct(scene, at), glm::dvec3(0.0));
  const glm::dvec3 bulb(1, 2, 1), l = bulb - at.position;
  scene.lights = {PointLight{bulb, {5, 4, 3}, {}}};
  EXPECT_NEAR(Direct(scene, at).y, 4 * l.y / std::pow(glm::length(l), 3) / kPi, 1e-12);
  const RectLight rect{{-0.5, 2.0, -0.4}, {1.2, 0, 0}, {0, 0, 0.7}, {3, 2, 1}, {}};  // shines down
  scene.lights = {rect};
  const std::vector<glm::dvec3> corners{rect.corner, rect.corner + rect.side_u, rect.corner + rect.side_u + rect.side_v,
                                        rect.corner + rect.side_v};
  const double expected = 3 * PolygonIrradiance(corners, at.position, at.normal) / kPi;
  EXPECT_NEAR(Direct(scene, at).x / expected, 1.0, 1e-3);  // 1024 points in a (0, 2)-sequence on a smooth integrand
  scene.lights = {RectLight{rect.corner, rect.side_v, rect.side_u, rect.radiance, {}}};
  EXPECT_EQ(Direct(scene, at), glm::dvec3(0.0)) << "shines up";
}

// Radiance times form factor: a point under an emitting plate, in Lambert's closed form.
TEST(PathTracer, FacingPlates) {
  Scene scene = FloorWorld(glm::vec3(0.0f));
  AddMaterial(scene, glm::vec3(0.0f), {3, 2, 1});
  AddQuad(scene, {-0.5, 1.0, -0.4}, {1.2, 0, 0}, {0, 0, 0.7}, 1);
  const Estimate e = Indirect(scene, Floor(), 1024, 32);
  const double factor =
      PolygonIrradiance({{-0.5, 1, -0.4}, {0.7, 1, -0.4}, {0.7, 1, 0.3}, {-0.5, 1, 0.3}}, Floor().position, {0, 1, 0}) /
      kPi;
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(e.sigma[c], 0.01 * (3 - c) * factor);
    EXPECT_NEAR(e.mean[c], (3 - c) * factor, 4 * e.sigma[c]);
  }
}

// Interreflection in a sphere of radius r and albedo a around a point light of intensity I: I / (pi r^2) directly, and
// a / (1 - a) of that by bounces. The facets of a sphere of 64 rings lie up to 0.12 % inside: 0.25 % in the light.
TEST(PathTracer, BouncesInASphere) {
  Scene scene;
  const glm::dvec3 albedo(0.6, 0.3, 0.9);
  AddMaterial(scene, glm::vec3(albedo));
  AddSphere(scene, {0, 2, 0}, 2.0, 64, 0);
  scene.lights = {PointLight{{0, 2, 0}, {8, 8, 8}, {}}};
  const double radius = 2.0 * 0.999;
  const LightPoint bottom{{0.03, 2.0 - radius, 0.03}, {0, 1, 0}, {0, 1, 0}};
  const Estimate e = Indirect(scene, bottom, 256, 64);
  for (int c = 0; c < 3; ++c) {
    const double expected = albedo[c] / (1 - albedo[c]) * 8 / (kPi * radius * radius);
    EXPECT_LT(e.sigma[c], 0.03 * expected);
    EXPECT_NEAR(e.mean[c], expected, 4 * e.sigma[c] + 0.0025 * expected) << c;
    const double forgotten = expected / albedo[c];
    EXPECT_GT(std::abs(e.mean[c] - forgotten), 4 * e.sigma[c] + 0.0025 * expected) << "an albedo forgotten must show";
  }
}

// Light sampling: one of two lamps is chosen at each bounce; the mean is the sum over both.
TEST(PathTracer, LampsAddUp) {
  Scene scene = FloorWorld(glm::vec3(0.8f));
  AddQuad(scene, {-3, 0, -1.5}, {6, 0, 0}, {0, 3, 0}, 0);
  const Light strong = PointLight{{1, 2, 1}, {5, 5, 5}, {}}, weak = PointLight{{-1, 1, 0.5}, {0.2, 0.1, 0.4}, {}};
  scene.lights = {strong};
  const Estimate a = Indirect(scene, Floor(), 256, 32);
  scene.lights = {weak};
  const Estimate b = Indirect(scene, Floor(), 256, 32);
  scene.lights = {strong, weak};
  const Estimate both = Indirect(scene, Floor(), 256, 32);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(both.mean[c], a.mean[c] + b.mean[c], 4 * std::hypot(both.sigma[c], a.sigma[c], b.sigma[c])) << c;
  }
}

// One layer of light per flicker; the layers add up to the total.
TEST(PathTracer, FlickersAreLayers) {
  Scene scene = FloorWorld(glm::vec3(0.8f));
  const Flicker mains{100, 0.3, 0.0};
  scene.lights = {PointLight{{1, 2, 1}, {5, 5, 5}, {}}, PointLight{{-1, 2, 1}, {1, 1, 1}, mains},
                  RectLight{{-0.5, 2.0, -0.4}, {1.2, 0, 0}, {0, 0, 0.7}, {3, 2, 1}, mains}};
  const RayScene rays(scene);
  const PathTracer tracer(scene, rays);
  ASSERT_EQ(tracer.layers().size(), 2u);
  glm::dvec3 layers[2]{};
  tracer.AddDirect(Floor(), 7, 64, layers);
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light)) point->flicker = {};
    if (auto* rect = std::get_if<RectLight>(&light)) rect->flicker = {};
  }
  EXPECT_NEAR(layers[0].x + layers[1].x, Direct(scene, Floor(), 64).x, 1e-12);
  scene.lights.resize(1);
  EXPECT_NEAR(layers[0].x, Direct(scene, Floor(), 64).x, 1e-12);
  for (int i = 0; i < kMaxLightLayers; ++i)
    scene.lights.push_back(PointLight{{1, 2, 1}, {1, 1, 1}, {100.0 + i, 0.5, 0}});
  EXPECT_THROW(PathTracer(scene, rays), std::invalid_argument);
}

}  // namespace
}  // namespace sim::test
