// Surfaces of glTF: cut-outs, texture transforms, emission, normal maps; and warnings about other features. Files are
// written by hand.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "sim/simulator.h"
#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// One triangle; `more` goes to the top level, `material` into its material, `node` into its node.
struct Parts {
  std::string material = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})";
  std::string more, node, attributes;
  std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
};

std::string Gltf(const Parts& parts) {
  const std::size_t n = parts.positions.size() / 3;
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)" + parts.node +
         R"(}],
    "meshes": [{"name": "flag", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1)" +
         parts.attributes + R"(}, "material": 0}]}],
    "materials": [{"name": "cloth", )" +
         parts.material + R"(}],
    "textures": [{"source": 0}, {"source": 1}], "images": [{"uri": "a%20picture.png"}, {"uri": "other.png"}],
    "buffers": [{"uri": "data.bin", "byteLength": )" +
         std::to_string(20 * n) + R"(}],
    "bufferViews": [{"buffer": 0, "byteLength": )" +
         std::to_string(12 * n) + R"(}, {"buffer": 0, "byteOffset": )" + std::to_string(12 * n) +
         R"(, "byteLength": )" + std::to_string(8 * n) + R"(}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": )" +
         std::to_string(n) + R"(, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
      {"bufferView": 1, "componentType": 5126, "count": )" +
         std::to_string(n) + R"(, "type": "VEC2"}])" + parts.more + "}";
}

Scene Load(const Folder& folder, const Parts& parts) {
  cv::Mat picture(2, 2, CV_8UC4, cv::Scalar(10, 20, 30, 255));
  picture.at<cv::Vec4b>(0, 1)[3] = 51;  // alpha of the texel at the upper right
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  folder.Write("a picture.png", {bytes.begin(), bytes.end()});
  folder.Write("other.png", EncodeColor(".png", 128, 128, 255));
  std::vector<float> data = parts.positions;
  for (std::size_t i = 0; i < parts.positions.size() / 3; ++i) {
    const float uv[3][2] = {{0.25f, 0.5f}, {0.75f, 0.5f}, {0.25f, 0.125f}};
    data.insert(data.end(), {uv[i % 3][0], uv[i % 3][1]});
  }
  folder.Write("data.bin", {reinterpret_cast<const char*>(data.data()), data.size() * sizeof(float)});
  WorldDescription world;
  world.meshes.push_back({folder.Write("flag.gltf", Gltf(parts)), {}, {1, 0, 0, 0}, 1.0, {}, {}});
  return LoadScene(world);
}

std::string Problems(const Folder& folder, const Parts& parts) {
  return ProblemTextOf([&] { Load(folder, parts); });
}

TEST(Gltf, PlainOneHasNoWarnings) {
  const Folder folder;
  const Scene scene = Load(folder, {});
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.textures, SizeIs(1));
  EXPECT_FALSE(scene.textures[0].has_alpha()) << "opaque materials have no alpha";
  EXPECT_EQ(scene.materials.at(0).alpha_cutoff, 0.0f);
  EXPECT_THAT(scene.meshes.at(0).normals, IsEmpty()) << "flat where the file has none";
}

TEST(Gltf, MaskIsACutOut) {
  const Folder folder;
  Parts parts;
  parts.material += R"(, "alphaMode": "MASK", "alphaCutoff": 0.25)";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.25f);
  ASSERT_TRUE(scene.textures.at(0).has_alpha());
  EXPECT_NEAR(scene.textures[0].Alpha({0.75f, 0.25f}), 0.2, 1e-6);
  EXPECT_NEAR(scene.textures[0].Alpha({0.25f, 0.25f}), 1.0, 1e-6);
  EXPECT_NEAR(scene.textures[0].Alpha({0.5f, 0.25f}), 0.6, 1e-6);
}

TEST(Gltf, BlendIsACutOutWithAWarning) {
  const Folder folder;
  Parts parts;
  parts.material += R"(, "alphaMode": "BLEND")";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings,
              ElementsAre(testing::AllOf(HasSubstr("flag.gltf"), HasSubstr("'cloth'"), HasSubstr("BLEND"))));
  EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.5f);
}

// uv' = offset + rotation(scale uv), with the rotation counter-clockwise where v is down: the extension's own matrices.
TEST(Gltf, TextureTransform) {
  const Folder folder;
  const double r = 0.7, sx = 2.0, sy = 3.0, ox = 0.1, oy = -0.2;
  Parts parts;
  parts.material = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
    {"offset": [0.1, -0.2], "rotation": 0.7, "scale": [2, 3]}}}})";
  parts.more = R"(, "extensionsUsed": ["KHR_texture_transform"])";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_THAT(mesh.uvs, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    // Texture coordinates of the vertex, by its position.
    const double u = mesh.positions[i].x > 0.5f ? 0.75 : 0.25, v = mesh.positions[i].y > 0.5f ? 0.125 : 0.5;
    EXPECT_NEAR(mesh.uvs[i].x, ox + std::cos(r) * sx * u + std::sin(r) * sy * v, 1e-5) << i;
    EXPECT_NEAR(mesh.uvs[i].y, oy - std::sin(r) * sx * u + std::cos(r) * sy * v, 1e-5) << i;
  }
}

// A node that mirrors leaves the front of a triangle in front (glTF 2.0, 3.7.4).
TEST(Gltf, AMirroredTriangleKeepsItsFront) {
  const Folder folder;
  for (const char* scale : {"[1, 1, 1]", "[-1, 1, 1]", "[1, -2, 3]"}) {
    Parts parts;
    parts.node = std::string(R"(, "scale": )") + scale;
    const Mesh mesh = Load(folder, parts).meshes.at(0);
    const glm::uvec3 t = mesh.triangles.at(0);
    const glm::vec3 corner = mesh.positions[t.x];
    EXPECT_GT(glm::cross(mesh.positions[t.y] - corner, mesh.positions[t.z] - corner).z, 0) << scale;
  }
}

TEST(Gltf, EmissionAndNormalMap) {
  const Folder folder;
  Parts parts;
  parts.material +=
      R"(, "emissiveFactor": [1, 0.5, 0.25], "emissiveTexture": {"index": 0}, "normalTexture": {"index": 1, "scale": 0.5},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}})";
  parts.more = R"(, "extensionsUsed": ["KHR_materials_emissive_strength"])";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.texture, m.emission_texture) << "one picture, read once";
  ASSERT_GE(m.normal_map, 0);
  const Texture& map = scene.textures.at(static_cast<std::size_t>(m.normal_map));
  EXPECT_EQ(map.content(), Texture::Content::numbers);
  EXPECT_NEAR(map.Texel(0, 0, 0).x, 128 / 255.0, 1e-3);
  EXPECT_NEAR(map.Texel(0, 0, 0).z, 1.0, 1e-3);
  EXPECT_FLOAT_EQ(m.normal_scale, 0.5f);
  EXPECT_FLOAT_EQ(m.emission.y, 2.0f);
}

TEST(Gltf, MetalAndRoughness) {
  const Folder folder;
  Parts parts;
  parts.material = R"("name": "cloth", "pbrMetallicRoughness": {"metallicFactor": 0.75, "roughnessFactor": 0.5,
    "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}})";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Material& m = scene.materials.at(0);
  EXPECT_FLOAT_EQ(m.metallic, 0.75f);
  EXPECT_FLOAT_EQ(m.roughness, 0.5f);
  ASSERT_GE(m.gloss_texture, 0);
  EXPECT_NE(m.gloss_texture, m.texture);
  const Texture& picture = scene.textures.at(static_cast<std::size_t>(m.gloss_texture));
  EXPECT_EQ(picture.content(), Texture::Content::numbers);
  EXPECT_NEAR(picture.Texel(0, 0, 0).x, 128 / 255.0, 1e-3) << "the bytes themselves, not their light";
}

TEST(Gltf, MetalWithoutReflectionsIsAWarning) {
  const Folder folder;
  Parts parts;
  parts.material = R"("pbrMetallicRoughness": {"metallicFactor": 1, "baseColorTexture": {"index": 0}})";
  Load(folder, parts);
  const auto file = folder.Write("tin.yaml", R"(
world: {meshes: [{file: flag.gltf}], lights: [{type: ambient, radiance: [1, 1, 1]}]}
camera: {width: 8, height: 6, fx: 8, fy: 8, cx: 3.5, cy: 2.5}
time: {rate: 30 Hz, duration: 100 ms}
trajectory: {type: rpy, start: {position: [0, 0, 3], look_at: [0, 0, 0]}, angles: [1 deg, 0 deg, 0 deg], periods: [1 s, 1 s, 1 s]}
)");
  EXPECT_THAT(
      Simulator(LoadScenario(file), 1).warnings(),
      testing::Contains(testing::AllOf(HasSubstr("render.reflections is false"), HasSubstr("material 'cloth'"))));
  EXPECT_THAT(Simulator(LoadScenario(file, {{"render.reflections", "true"}}), 1).warnings(),
              testing::Not(testing::Contains(HasSubstr("reflections"))));
  // Factors times the texture: roughness in green, metallic in blue. other.png has 128 and 255.
  for (const auto& [factors, is_said] : {std::pair{R"("metallicFactor": 0.4, "roughnessFactor": 1)", false},
                                         {R"("metallicFactor": 1, "roughnessFactor": 1)", true},
                                         {R"("metallicFactor": 0, "roughnessFactor": 0.9)", true}}) {
    parts.material =
        std::string(R"("pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 1}, )") + factors + "}";
    Load(folder, parts);
    const auto said = Contains(HasSubstr("render.reflections is false"));
    EXPECT_EQ(testing::Matches(said)(Simulator(LoadScenario(file), 1).warnings()), is_said) << factors;
  }
}

TEST(Gltf, PicturesWithOtherCoordinatesAreLeftOut) {
  const Folder folder;
  Parts parts;
  parts.material += R"(, "normalTexture": {"index": 1, "texCoord": 1})";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings,
              ElementsAre(testing::AllOf(HasSubstr("'cloth'"), HasSubstr("other.png"), HasSubstr("left out"))));
  EXPECT_EQ(scene.materials.at(0).normal_map, -1);
}

TEST(Gltf, TrianglesWithoutAreaAreCounted) {
  const Folder folder;
  Parts parts;
  parts.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* on a line */ 0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 1, 1, /* one point */ 1,
                     0, 0, 1, 0, 0, 1, 0, 0};
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.meshes.at(0).triangles, SizeIs(1));
  EXPECT_THAT(scene.warnings, ElementsAre(testing::AllOf(HasSubstr("flag"), HasSubstr("2 of 3 triangles"))));
}

TEST(Gltf, HugeCoordinates) {
  const Folder folder;
  Parts parts;
  parts.node = R"(, "translation": [0, 0, 4194304])";  // 2^22: floats are half a metre apart
  EXPECT_THAT(Problems(folder, parts),
              testing::AllOf(HasSubstr("flag.gltf"), HasSubstr("4.19"), HasSubstr("position")));
  parts.node = R"(, "translation": [0, 0, 1024])";
  EXPECT_THAT(Load(folder, parts).warnings, ElementsAre(HasSubstr("coarse")));
  // Control: moved back near the origin in double, without a loss.
  parts.node = R"(, "translation": [0, 0, 4194304])";
  WorldDescription world;
  world.meshes.push_back({folder.Write("far.gltf", Gltf(parts)), {0, 0, -4194304.0}, {1, 0, 0, 0}, 1.0, {}, {}});
  const Scene scene = LoadScene(world);
  EXPECT_THAT(scene.warnings, IsEmpty());
  for (const glm::vec3& x : scene.meshes.at(0).positions) EXPECT_NEAR(x.z, 0.0, 1e-6);
}

// Coordinates that are coarse in the file, wherever the mesh is moved.
TEST(Gltf, HugeCoordinatesOfVertices) {
  const Folder folder;
  Parts parts;
  parts.positions = {0, 0, 4194304, 1, 0, 4194304, 0, 1, 4194304};
  EXPECT_THAT(Problems(folder, parts), HasSubstr("move it near the origin"));
  WorldDescription world;
  world.meshes.push_back({folder.path() / "flag.gltf", {0, 0, -4194304.0}, {1, 0, 0, 0}, 1.0, {}, {}});
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(world); }), HasSubstr("4.1943e+06), where numbers are 0.25 coarse"));
}

TEST(Gltf, WantsAReaderOfAnotherVersion) {
  const Folder folder;
  std::string text = Gltf({});
  text.replace(text.find("\"2.0\""), 5, R"("2.1", "minVersion": "2.1")");
  const auto file = folder.Write("flag.gltf", text);
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(file)); }), HasSubstr("needs a reader of glTF 2.1"));
}

TEST(Gltf, WhatIsNotRenderedIsNamed) {
  const Folder folder;
  Parts parts;
  parts.material += R"(, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}})";
  parts.more = R"(, "extensionsUsed": ["KHR_materials_clearcoat", "MAKER_something"])";
  const std::vector<std::string> warnings = Load(folder, parts).warnings;
  EXPECT_THAT(warnings, SizeIs(2));
  EXPECT_THAT(warnings, Contains(HasSubstr("KHR_materials_clearcoat: clear coats")));
  EXPECT_THAT(warnings, Contains(HasSubstr("MAKER_something")));
  parts.material = R"("doubleSided": true)";
  parts.more = R"(, "animations": [{}], "skins": [{}])";
  EXPECT_THAT(Load(folder, parts).warnings, ElementsAre(HasSubstr("animations")));
}

TEST(Gltf, WhatCannotBeReadIsAnError) {
  const Folder folder;
  for (const std::string name : {"MAKER_geometry", "KHR_future"}) {
    Parts parts;
    parts.more = R"(, "extensionsUsed": [")" + name + R"("], "extensionsRequired": [")" + name + R"("])";
    EXPECT_THAT(Problems(folder, parts), testing::AllOf(HasSubstr("flag.gltf"), HasSubstr(name)));
  }
}

TEST(Gltf, MaterialExtensions) {
  const Folder folder;
  Parts parts;
  parts.material = R"("extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 0.5, 0.25, 1],
    "diffuseTexture": {"index": 0}, "glossinessFactor": 0.25}})";
  parts.more = R"(, "extensionsRequired": ["KHR_materials_pbrSpecularGlossiness"])";
  Material material = Load(folder, parts).materials.at(0);
  EXPECT_EQ(material.base_color, glm::vec3(1, 0.5, 0.25));
  EXPECT_GE(material.texture, 0);
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.roughness, 0.75f);

  parts.material =
      R"("emissiveFactor": [0.5, 0, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}})";
  parts.more = R"(, "extensionsRequired": ["KHR_materials_emissive_strength"])";
  material = Load(folder, parts).materials.at(0);
  EXPECT_EQ(material.emission, glm::vec3(4, 0, 0));
  EXPECT_EQ(material.metallic, 1.0f) << "glTF's default";

  // Unlit: radiance is the base colour times its texture, without reflection.
  parts.material = R"("extensions": {"KHR_materials_unlit": {}},
    "pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1], "baseColorTexture": {"index": 0}})";
  parts.more = R"(, "extensionsRequired": ["KHR_materials_unlit"])";
  material = Load(folder, parts).materials.at(0);
  EXPECT_EQ(material.base_color, glm::vec3(0));
  EXPECT_EQ(material.emission, glm::vec3(0.5, 1, 1));
  EXPECT_EQ(material.emission_texture, material.texture);
  EXPECT_FALSE(material.Mirrors());
}

// Coordinate set of the transform, which overrides that of the texture.
TEST(Gltf, TextureTransformNamesASet) {
  const Folder folder;
  Parts parts;
  parts.attributes = R"(, "TEXCOORD_1": 1)";
  parts.material = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 5,
    "extensions": {"KHR_texture_transform": {"texCoord": 1}}}})";
  const Scene scene = Load(folder, parts);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.meshes.at(0).uvs, SizeIs(3));
}

TEST(Gltf, VersionsOfAPicture) {
  const Folder folder;
  folder.Write("x.webp", EncodeColor(".webp", 200, 100, 0));
  Parts parts;
  const auto with = [&](const std::string& texture) {
    std::string text = Gltf(parts);
    text.replace(text.find(R"([{"source": 0})"), 14, "[" + texture);
    text.replace(text.find(R"({"uri": "other.png"})"), 20, R"({"uri": "x.webp"})");
    Load(folder, parts);  // writes the other files
    WorldDescription world;
    world.meshes.push_back({folder.Write("flag.gltf", text), {}, {1, 0, 0, 0}, 1.0, {}, {}});
    return LoadScene(world);
  };
  const Scene webp = with(R"({"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}})");
  EXPECT_THAT(webp.textures.at(0).name(), HasSubstr("x.webp"));
  EXPECT_THAT(with(R"({"source": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}})").textures.at(0).name(),
              HasSubstr("picture.png"));
  EXPECT_THAT(ProblemTextOf([&] { with(R"({"extensions": {"KHR_texture_basisu": {"source": 1}}})"); }),
              testing::AllOf(HasSubstr("KHR_texture_basisu"), HasSubstr("convert them to PNG")));
}

// Instances of a node, with translations only.
TEST(Gltf, GpuInstancing) {
  const Folder folder;
  Parts parts;
  parts.node = R"(, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}})";
  const Scene scene = Load(folder, parts);
  ASSERT_THAT(scene.meshes, SizeIs(3));
  EXPECT_EQ(scene.meshes[1].positions.at(0), glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[2].positions.at(1), glm::vec3(1, 1, 0));
}

TEST(Gltf, InvisibleNodesAreNotRendered) {
  const Folder folder;
  Parts parts;
  parts.more = R"(, "extensionsUsed": ["KHR_node_visibility"])";
  parts.node = R"(, "extensions": {"KHR_node_visibility": {"visible": true}})";
  EXPECT_THAT(Load(folder, parts).meshes, SizeIs(1));
  parts.node = R"(, "extensions": {"KHR_node_visibility": {"visible": false}})";
  EXPECT_THAT(Problems(folder, parts), HasSubstr("has no triangles"));
}

}  // namespace
}  // namespace sim::test
