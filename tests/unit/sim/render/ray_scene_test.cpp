// The ray scene: which triangle a ray meets does not depend on the threads that have built the tree.
#include "sim/render/ray_scene.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "sim/render/embree.h"

namespace sim {
namespace {

// Three equal sheets of side² squares at z = 1 m, whose corners lie on whole pixels of f = side px: each ray through a
// corner meets 18 triangles at once. Then triangles at random places, each of them twice.
Scene Ties(std::uint32_t side, int scattered, std::uint32_t seed) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.material = 0;
  for (int sheet = 0; sheet < 3; ++sheet) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t y = 0; y <= side; ++y) {
      for (std::uint32_t x = 0; x <= side; ++x) {
        const auto at = [&](std::uint32_t i) { return static_cast<float>(i) / static_cast<float>(side) - 0.5f; };
        mesh.positions.emplace_back(at(x), at(y), 1.0f);
        if (x == side || y == side) continue;
        const std::uint32_t a = first + y * (side + 1) + x, b = a + side + 1;
        mesh.triangles.emplace_back(a, b, b + 1);
        mesh.triangles.emplace_back(a, b + 1, a + 1);
      }
    }
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-0.5f, 0.5f), size(-0.02f, 0.02f);
  for (int i = 0; i < scattered; ++i) {
    const glm::vec3 center(place(random), place(random), place(random) + 1.0f);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner)
      mesh.positions.push_back(center + glm::vec3(size(random), size(random), size(random)));
    for (int copy = 0; copy < 2; ++copy) mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return scene;
}

std::vector<std::uint32_t> Hits(const Scene& scene, int threads, int side) {
  std::unique_ptr<RayScene> rays;
  tbb::task_arena(threads).execute([&] { rays = std::make_unique<RayScene>(scene); });
  std::vector<std::uint32_t> hits;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      RTCRayHit ray{};
      ray.ray.dir_x = static_cast<float>(x) / static_cast<float>(side) - 0.5f;
      ray.ray.dir_y = static_cast<float>(y) / static_cast<float>(side) - 0.5f;
      ray.ray.dir_z = 1;
      ray.ray.tfar = 10;
      ray.ray.mask = ~0u;
      ray.hit.geomID = ray.hit.primID = RTC_INVALID_GEOMETRY_ID;
      Intersect1(rays->embree(), &ray);
      hits.push_back(ray.hit.primID);
    }
  }
  return hits;
}

TEST(RayScene, TheTriangleMetDoesNotDependOnThreads) {
  static constexpr int kSide = 256;
  const Scene scene = Ties(kSide, 200000, 1);
  const std::vector<std::uint32_t> one = Hits(scene, 1, kSide);
  for (const int threads : {2, 3, 8, 2, 3, 8}) EXPECT_TRUE(Hits(scene, threads, kSide) == one) << threads;
  // Control: with the triangles in another order, rays through the same edges meet others.
  Scene turned = scene;
  std::vector<glm::uvec3>& triangles = turned.meshes[0].triangles;
  std::reverse(triangles.begin(), triangles.end());
  std::vector<std::uint32_t> other = Hits(turned, 1, kSide);
  for (std::uint32_t& hit : other) {
    if (hit != RTC_INVALID_GEOMETRY_ID) hit = static_cast<std::uint32_t>(triangles.size()) - 1 - hit;
  }
  EXPECT_FALSE(other == one);
}

}  // namespace
}  // namespace sim
