#include <gtest/gtest.h>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

TEST(Depth, PlaneThroughADistortedLens) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  // z = 3 + x / 2 - y / 4, in numbers that floats hold exactly.
  AddQuad(scene, {-16, -16, -1}, {32, 0, 16}, {0, 32, -8}, 0);
  const glm::dvec3 n = glm::dvec3(0.5, -0.25, -1.0), at(0, 0, 3);
  const Camera camera(DistortedCamera());
  const Pose pose = TiltedPose();
  const std::vector<float> depth = DepthOf(*MakeRayTracer(scene), camera, pose);
  ASSERT_EQ(depth.size(), 120u * 90u);
  for (int v = 0; v < 90; ++v) {
    for (int u = 0; u < 120; ++u) {
      const double z = glm::dot(n, at - pose.p_WC) / glm::dot(n, RayInWorld(camera, pose, u, v));
      ASSERT_NEAR(depth[static_cast<std::size_t>(v * 120 + u)] / z, 1.0, 2e-7)
          << u << ", " << v;  // rounding to float: 6e-8
    }
  }
}

TEST(Depth, SphereAndNothingBesideIt) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  const glm::dvec3 center(0.1, -0.2, 4.0);
  const int rings = 300;
  AddSphere(scene, center, 1.0, rings, 0);
  const Camera camera(DistortedCamera());
  const std::vector<float> depth = DepthOf(*MakeRayTracer(scene), camera, Pose{});
  int hits = 0, misses = 0;
  for (int v = 0; v < 90; ++v) {
    for (int u = 0; u < 120; ++u) {
      const float measured = depth[static_cast<std::size_t>(v * 120 + u)];
      const glm::dvec3 ray = RayInWorld(camera, Pose{}, u, v), d = glm::normalize(ray);
      const double along = glm::dot(d, center), miss = std::sqrt(glm::dot(center, center) - along * along);
      if (miss > 1.0) {
        ++misses;
        ASSERT_EQ(measured, 0.0f) << u << ", " << v;
      } else if (miss < 0.95) {
        ++hits;
        const double z = (along - std::sqrt(1 - miss * miss)) / glm::length(ray);
        // Facets lie up to 2 (1 - cos(pi / (2 rings))) = 3e-5 inside the sphere, along a ray that meets them at 18
        // degrees or more.
        ASSERT_GE(measured, z - 1e-6) << u << ", " << v;
        ASSERT_LE(measured, z + 3e-5 / std::sqrt(1 - 0.95 * 0.95)) << u << ", " << v;
      }
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(Depth, EmptyWorld) {
  EXPECT_EQ(DepthOf(*MakeRayTracer(Scene{}), Camera(SmallCamera(5, 3)), Pose{}), std::vector<float>(15, 0.0f));
}

}  // namespace
}  // namespace sim::test
