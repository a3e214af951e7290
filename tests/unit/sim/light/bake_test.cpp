// Samples of baked light on triangles: number, places, equality along shared edges and for any number of threads.
#include "sim/light/bake.h"

#include <gmock/gmock.h>
#include <tbb/task_arena.h>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

BakeParams Quick() {
  BakeParams params;
  params.spacing_m = 0.5;
  params.min_spacing_m = 0.02;
  params.paths = 16;
  params.lamp_rays = 16;
  return params;
}

// A room of 4 m x 3 m x 4 m with a lamp under its ceiling and a table.
Scene Room() {
  Scene scene;
  AddMaterial(scene, {0.8f, 0.7f, 0.6f});
  AddBox(scene, {0, 0, 0}, {4, 3, 4}, 0);
  AddBox(scene, {1, 0.7f, 1}, {2, 0.8f, 2}, 0);
  scene.lights = {PointLight{{2.5, 2.5, 2.0}, {5, 5, 5}, {}}};
  return scene;
}

TEST(Bake, SpacingSetsTheResolution) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.5f));
  AddQuad(scene, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 0);  // longest side 5.66 m
  scene.sky = Sky{{1, 2, 3}, {2, 1, 1}, {1, 1, 1}, 0, 0, {}, 0.0};
  const RayScene rays(scene);
  const BakedLight light = BakeLight(scene, rays, LightMode::baked_indirect, Quick());
  ASSERT_EQ(light.resolutions.size(), 2u);
  for (const TriangleResolution& r : light.resolutions) {
    EXPECT_EQ(r.log2_front, 4);  // 16 steps of 0.35 m
    EXPECT_EQ(r.log2_back, 4);
  }
  EXPECT_EQ(light.samples.size(), 4 * LatticeSize(16));
}

// Spacing by the limit of 256 steps a side (2048 for lamps): 0.39 m (0.049 m) on two triangles with a longest side of
// 100 m; two more triangles with one of 5.66 m.
TEST(Bake, WarnsWhereSamplesAreFartherApartThanAsked) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.5f));
  AddQuad(scene, {0, 0, 0}, {60, 0, 0}, {0, 80, 0}, 0);
  AddQuad(scene, {0, 0, 9}, {4, 0, 0}, {0, 4, 0}, 0);
  BakeParams params = Quick();
  const auto warnings = [&](LightMode mode) { return BakeWarnings(scene, RayScene(scene), mode, params); };
  params.spacing_m = 0.391, params.min_spacing_m = 0.05;
  EXPECT_THAT(warnings(LightMode::baked), testing::IsEmpty());
  params.spacing_m = 0.2;
  const std::string coarse =
      "baked light: samples are up to 0.391 m apart on 2 triangles, not render.bake.spacing = 0.2 m: a side is divided "
      "into 256 at most";
  EXPECT_THAT(warnings(LightMode::baked_indirect), testing::ElementsAre(coarse));
  EXPECT_THAT(warnings(LightMode::baked), testing::ElementsAre(coarse));
  params.min_spacing_m = 0.04;
  EXPECT_THAT(warnings(LightMode::baked),
              testing::ElementsAre(
                  coarse + "; those of lamps are up to 0.0488 m apart on 2 triangles, not render.bake.min_spacing = "
                           "0.04 m: a side is divided into 2048 at most"));
  params.spacing_m = 0.01, params.min_spacing_m = 0.01;
  EXPECT_THAT(warnings(LightMode::baked_indirect),
              testing::ElementsAre(testing::HasSubstr("0.391 m apart on 4 triangles, not")));
}

// The baked light has the spacing of the warning, which appears once.
TEST(Bake, LongTrianglesAreCoarse) {
  Scene scene;
  AddMaterial(scene, glm::vec3(0.5f));
  AddQuad(scene, {0, 0, 0}, {60, 0, 0}, {0, 80, 0}, 0);
  scene.sky = Sky{{1, 2, 3}, {2, 1, 1}, {1, 1, 1}, 0, 0, {}, 0.0};
  BakeParams params = Quick();
  params.spacing_m = 0.2;
  params.paths = 1;
  std::vector<std::string> warnings;
  LitScene(scene, LightMode::baked_indirect, params, {}, warnings);
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("up to 0.391 m apart on 2 triangles")));
  const BakedLight light = BakeLight(scene, RayScene(scene), LightMode::baked_indirect, params);
  EXPECT_EQ(light.resolutions[0].log2_front, 8);
}

TEST(Bake, NeighboursShareTheirSamples) {
  Scene scene = Room();
  scene.meshes.resize(1);  // one wall: two triangles that meet in a diagonal
  scene.sky = Sky{{1, 2, 3}, {2, 1, 1}, {1, 1, 1}, 0, 0, {}, 0.0};
  const RayScene rays(scene);
  const BakedLight light = BakeLight(scene, rays, LightMode::baked_indirect, Quick());
  const std::size_t log2 = light.resolutions[0].log2_front, r = std::size_t{1} << log2, n = LatticeSize(r);
  // Triangles (0, 1, 2) and (0, 2, 3): the diagonal is u = 0 in the first and v = 0 in the second. Front and back of
  // each.
  const std::uint32_t* first = light.samples.data();
  const std::uint32_t* second = first + 2 * n;
  std::set<std::uint32_t> different;
  for (std::size_t k = 0; k <= r; ++k) {
    EXPECT_EQ(first[LatticeIndex(r, 0, k)], second[LatticeIndex(r, k, 0)]) << k;
    different.insert(first[LatticeIndex(r, 0, k)]);
  }
  EXPECT_GT(different.size(), 2u);  // control: estimates of 16 paths each differ from place to place
}

TEST(Bake, ThreadsDoNotMatter) {
  const Scene scene = Room();
  const RayScene rays(scene);
  BakedLight one, two;
  tbb::task_arena(1).execute([&] { one = BakeLight(scene, rays, LightMode::baked, Quick()); });
  tbb::task_arena(2).execute([&] { two = BakeLight(scene, rays, LightMode::baked, Quick()); });
  EXPECT_EQ(one.samples, two.samples);
  EXPECT_GT(one.samples.size(), 1000u);
}

// Adaptive resolution: corners only on the dark outside of the room, the finest at the edge of the table's shadow on
// the floor.
TEST(Bake, FineWhereAnEdgeIs) {
  const Scene scene = Room();
  const RayScene rays(scene);
  const BakedLight light = BakeLight(scene, rays, LightMode::baked, Quick());
  bool any_fine = false;
  for (std::size_t t = 0; t < 12; ++t) {  // the room's walls
    const TriangleResolution r = light.resolutions[t];
    EXPECT_EQ(std::min(r.log2_front, r.log2_back), 0) << t;
    any_fine = any_fine || std::max(r.log2_front, r.log2_back) == 9;  // 5.66 m in 512 steps of 0.011 m
    EXPECT_GE(std::max(r.log2_front, r.log2_back), 4) << t;
  }
  EXPECT_TRUE(any_fine);
}

TEST(Bake, BadParametersAreRefused) {
  const Scene scene = Room();
  const RayScene rays(scene);
  BakeParams params;
  params.paths = 100;
  EXPECT_THROW(BakeLight(scene, rays, LightMode::baked, params), std::invalid_argument);
  params = {};
  params.min_spacing_m = 1;
  EXPECT_THROW(BakeLight(scene, rays, LightMode::baked, params), std::invalid_argument);
  EXPECT_THROW(BakeLight(scene, rays, LightMode::direct, {}), std::invalid_argument);
}

}  // namespace
}  // namespace sim::test
