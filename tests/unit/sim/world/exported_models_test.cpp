// One textured model as Blender and assimp's exporter write it in six formats (exported/export_model.py): the same
// albedo and depth.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/render/ray_scene.h"
#include "sim/scenario/readers.h"
#include "source_dir.h"
#include "tests/unit/sim/render/worlds.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Picture {
  RadianceImage albedo;
  std::vector<float> depth;
};

// Albedo and depth: ambient light of radiance 1 makes radiance the albedo.
Picture PictureOf(const Scene& scene, const glm::dvec3& eye) {
  CameraParams lens = SmallCamera(320, 240);
  lens.fx = lens.fy = 262.5;
  const Camera camera(lens);
  const Pose pose{eye, LookAt(eye, {0.3, 0.9, 0.2}, 0)};
  const RayScene rays(scene);
  return {Render(scene, camera, pose), SurfaceTracer(rays, 1).Depth(camera, {pose, 0})};
}

// Largest relative difference; infinite where only one image has a surface.
double DepthDifference(const Picture& a, const Picture& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    if (a.depth[i] == b.depth[i]) continue;
    if (!(a.depth[i] > 0 && b.depth[i] > 0)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(1.0 - a.depth[i] / b.depth[i]));
  }
  return largest;
}

class ExportedModels : public testing::Test {
 protected:
  static Scene Load(const std::string& name, double scale = 1) {
    WorldDescription world = WorldOf(std::string(VOBENCH_SOURCE_DIR "/tests/unit/sim/world/exported/") + name);
    world.meshes[0].scale = scale;
    world.lights = {AmbientLight{}};
    return LoadScene(world);
  }
  static constexpr glm::dvec3 kEyes[] = {{1.8, 1.9, 1.4}, {-0.8, 1.8, -1.2}};
};

TEST_F(ExportedModels, LookTheSameInAllFormats) {
  const Scene reference = Load("blender/model.glb");
  std::vector<Picture> expected;
  for (const glm::dvec3& eye : kEyes) expected.push_back(PictureOf(reference, eye));
  for (const auto& [name, scale] : {std::pair{"blender/model.gltf", 1.0},
                                    {"blender/model.obj", 1.0},
                                    {"blender/model.ply", 1.0},
                                    {"blender/model.dae", 1.0},
                                    {"blender/model.fbx", 1.0},
                                    {"assimp/model.gltf", 1.0},
                                    {"assimp/model.glb", 1.0},
                                    {"assimp/model.obj", 1.0},
                                    {"assimp/model.ply", 1.0},
                                    {"assimp/model.dae", 1.0},
                                    {"assimp/model.ascii.fbx", 100.0}}) {  // metres with a unit of centimetres
    SCOPED_TRACE(name);
    const Scene scene = Load(name, scale);
    EXPECT_THAT(scene.warnings,
                testing::Each(testing::AnyOf(HasSubstr("reflections"), HasSubstr("/paint.png': a texture is taken"))));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Picture picture = PictureOf(scene, kEyes[i]);
      EXPECT_GE(Psnr(picture.albedo.rgb, expected[i].albedo.rgb), 45);
      EXPECT_LE(DepthDifference(picture, expected[i]), 1e-5);
    }
  }
}

// Controls: a texture upside down and a model that is 1e-4 too large are rejected.
TEST_F(ExportedModels, DoNotWithThePictureUpsideDownNorInAnotherSize) {
  const Scene reference = Load("blender/model.glb");
  Scene turned = reference;
  for (Mesh& mesh : turned.meshes)
    for (glm::vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  const Picture expected = PictureOf(reference, kEyes[0]);
  EXPECT_LT(Psnr(PictureOf(turned, kEyes[0]).albedo.rgb, expected.albedo.rgb), 35);
  EXPECT_GT(DepthDifference(PictureOf(Load("blender/model.glb", 1.0001), kEyes[0]), expected), 1e-5);
}

// A record with a wrong end offset, which Blender's reader refuses as well.
TEST_F(ExportedModels, BinaryFbxOfAssimpIsRefused) {
  EXPECT_THAT(ProblemTextOf([] { Load("assimp/model.fbx"); }), HasSubstr("out of range"));
}

}  // namespace
}  // namespace sim::test
