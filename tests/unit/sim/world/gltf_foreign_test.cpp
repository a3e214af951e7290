// glTF files as other programs write them, damaged ones included: what is seen, warned of and refused.
#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A quad, from (-1, -1) to (1, 1), with a picture: a document to be changed.
struct Quad {
  Folder folder;
  std::string data;
  json file = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}, "material": 0}]}],
    "materials": [{"name": "cloth", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"uri": "p.png"}], "bufferViews": [], "accessors": [],
    "buffers": [{"uri": "data.bin"}]})");

  Quad() {
    folder.Write("p.png", EncodeColor(".png", 200, 100, 50));
    attributes()["POSITION"] = Add<float>(5126, "VEC3", {-1, 1, 0, 1, 1, 0, -1, -1, 0, 1, -1, 0});
    attributes()["TEXCOORD_0"] = Add<float>(5126, "VEC2", {0, 0, 1, 0, 0, 1, 1, 1});
    primitive()["indices"] = Add<std::uint16_t>(5123, "SCALAR", {0, 2, 1, 1, 2, 3});
  }

  json& primitive() { return file["meshes"][0]["primitives"][0]; }
  json& attributes() { return primitive()["attributes"]; }
  json& node() { return file["nodes"][0]; }
  json& material() { return file["materials"][0]; }

  // The index of a new accessor.
  template <class T>
  int Add(int component, const std::string& type, const std::vector<T>& values, bool normalised = false) {
    data.resize((data.size() + 3) / 4 * 4);
    const std::size_t size = values.size() * sizeof(T), columns = type == "SCALAR" ? 1
                                                                  : type == "MAT4" ? 16
                                                                                   : type[3] - '0';
    file["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", size}});
    data.append(reinterpret_cast<const char*>(values.data()), size);
    file["accessors"].push_back({{"bufferView", file["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", values.size() / columns},
                                 {"type", type},
                                 {"normalized", normalised}});
    return static_cast<int>(file["accessors"].size()) - 1;
  }
  // The same four numbers for each vertex.
  int AddToAll(const std::vector<float>& row) {
    std::vector<float> values;
    for (int i = 0; i < 4; ++i) values.insert(values.end(), row.begin(), row.end());
    return Add(5126, "VEC" + std::to_string(row.size()), values);
  }
  void Instances(const json& of) {
    node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = of;
    file["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  }

  Scene Load(MissingTextures missing = MissingTextures::error) {
    json& buffer = file["buffers"][0];
    if (!buffer.contains("byteLength")) buffer["byteLength"] = data.size();
    folder.Write("data.bin", data);
    WorldDescription world = WorldOf(folder.Write("m.gltf", file.dump()));
    world.missing_textures = missing;
    return LoadScene(world);
  }
  std::string Problem() {
    return ProblemTextOf([&] { Load(); });
  }
  const Material& MaterialOf(const Scene& scene) const {
    return scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).material));
  }
};

TEST(GltfForeign, InstancesOfUnequalCountsAreRefused) {
  for (const bool first_is_short : {true, false}) {
    Quad quad;
    const int one = quad.Add<float>(5126, "VEC3", {1, 1, 1}), two = quad.Add<float>(5126, "VEC3", {1, 1, 1, 2, 2, 2});
    quad.Instances({{"TRANSLATION", first_is_short ? one : two}, {"SCALE", first_is_short ? two : one}});
    EXPECT_THAT(quad.Problem(), HasSubstr("nodes[0]: EXT_mesh_gpu_instancing: SCALE"));
    quad.Instances({{"TRANSLATION", two}, {"SCALE", two}});
    EXPECT_THAT(quad.Load().meshes, SizeIs(2));
  }
}

TEST(GltfForeign, UnlitIsTimesTheVertexColour) {
  Quad quad;
  quad.material()["extensions"]["KHR_materials_unlit"] = json::object();
  quad.material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0.5, 1, 1};
  quad.attributes()["COLOR_0"] = quad.AddToAll({0.25f, 0.5f, 1});
  Scene scene = quad.Load();
  EXPECT_EQ(quad.MaterialOf(scene).emission, glm::vec3(0.25, 0.25, 1));
  EXPECT_GE(quad.MaterialOf(scene).emission_texture, 0);
  EXPECT_THAT(scene.warnings, IsEmpty());
  quad.attributes()["COLOR_0"] = quad.Add<float>(5126, "VEC3", {1, 1, 1, 0, 1, 1, 1, 1, 1, 0, 1, 1});
  scene = quad.Load();
  EXPECT_EQ(quad.MaterialOf(scene).emission, glm::vec3(0.5, 0.5, 1));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("their mean")));
}

TEST(GltfForeign, WhatHasNoSizeIsNotSeen) {
  Quad quad;
  quad.attributes()["NORMAL"] = quad.AddToAll({0, 0, 1});
  quad.file["nodes"].push_back({{"mesh", 0}, {"scale", {0, 0, 0}}});
  quad.file["scenes"][0]["nodes"] = {0, 1};
  EXPECT_THAT(quad.Load().meshes, SizeIs(1));
  quad.file["nodes"][1]["scale"] = {1, 1, 0};  // the quad is flat in z
  Scene scene = quad.Load();
  EXPECT_THAT(scene.meshes, SizeIs(2));
  EXPECT_EQ(scene.meshes.back().normals.at(0), glm::vec3(0, 0, 1));
  EXPECT_THAT(scene.warnings, IsEmpty());
  quad.file["scenes"][0]["nodes"] = {0};
  quad.Instances({{"SCALE", quad.Add<float>(5126, "VEC3", {1, 1, 1, 0, 0, 0})}});
  EXPECT_THAT(quad.Load().meshes, SizeIs(1));
  quad.Instances({{"SCALE", quad.Add<float>(5126, "VEC3", {0, 0, 0})}});
  EXPECT_THAT(quad.Problem(), HasSubstr("has no triangles: its nodes have a scale of 0"));
  quad.file["scenes"][0]["nodes"] = {0, 1};
  for (const double large : {1e39, 1e300}) {
    quad.file["nodes"][1] = {{"mesh", 0}, {"translation", {large, 0, 0}}};
    EXPECT_THAT(quad.Problem(), HasSubstr("nodes[1]: its transform is not finite")) << large;
  }
}

TEST(GltfForeign, WeightsOfANodeAreInThePlaceOfTheMeshs) {
  Quad quad;
  quad.primitive()["targets"] = {{{"POSITION", 0}}};
  quad.node()["weights"] = {1};
  EXPECT_THAT(quad.Load().warnings, ElementsAre(HasSubstr("morph targets")));
  quad.node()["weights"] = {0};
  quad.file["meshes"][0]["weights"] = {1};
  EXPECT_THAT(quad.Load().warnings, IsEmpty());
}

// A vertex stands where its joints do, and the transform of the mesh's node does not count (glTF 2.0, 3.7.3.3).
TEST(GltfForeign, SkinsStandInTheirPose) {
  Quad quad;
  quad.attributes()["NORMAL"] = quad.AddToAll({0, 0, 1});
  quad.attributes()["WEIGHTS_0"] = quad.AddToAll({0.75f, 0.25f, 0, 0});
  quad.attributes()["JOINTS_0"] =
      quad.Add<std::uint8_t>(5121, "VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  std::vector<float> inverses(32, 0.0f);
  for (const std::size_t i : {0u, 5u, 10u, 16u, 21u, 26u}) inverses[i] = 2;
  inverses[15] = inverses[31] = 1;
  quad.node() = {{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}};
  quad.file["nodes"].push_back({{"translation", {0, 0, 4}}, {"children", {2}}});
  quad.file["nodes"].push_back({{"translation", {8, 0, 0}}});
  quad.file["scenes"][0]["nodes"] = {0, 1};
  quad.file["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", quad.Add(5126, "MAT4", inverses)}}};
  const Scene scene = quad.Load();
  EXPECT_EQ(scene.meshes.at(0).positions.at(0), glm::vec3(-2 + 0.25 * 8, 2, 4));
  EXPECT_EQ(scene.meshes.at(0).normals.at(0), glm::vec3(0, 0, 1));
  EXPECT_THAT(scene.warnings, IsEmpty());
  quad.file["skins"][0]["joints"] = {1};
  EXPECT_THAT(quad.Problem(), HasSubstr("meshes[0]: a vertex names a joint that does not exist"));
}

TEST(GltfForeign, AlphaOfVertexColours) {
  Quad quad;
  quad.material()["alphaMode"] = "MASK";
  quad.attributes()["COLOR_0"] = quad.AddToAll({1, 1, 1, 0.25f});
  Scene scene = quad.Load();
  EXPECT_EQ(quad.MaterialOf(scene).alpha, 0.25f);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("'cloth': its alpha is below 0.5 everywhere: it is not seen")));
  quad.material()["alphaMode"] = "OPAQUE";
  scene = quad.Load();
  EXPECT_EQ(quad.MaterialOf(scene).alpha, 1.0f);
  EXPECT_THAT(scene.warnings, IsEmpty());
  quad.attributes()["COLOR_0"] = quad.Add<float>(5126, "VEC4", {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  EXPECT_THAT(quad.Load().warnings, IsEmpty());
  quad.material()["alphaMode"] = "MASK";
  EXPECT_THAT(quad.Load().warnings, ElementsAre(HasSubstr("alpha of its vertex colours is not used")));
}

// The cutoff and the factor decide.
TEST(GltfForeign, WhatACutOffHidesIsSaid) {
  Quad quad;
  const cv::Mat picture(4, 4, CV_8UC4, cv::Scalar(10, 20, 30, 100));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  quad.folder.Write("p.png", {bytes.begin(), bytes.end()});
  quad.material()["alphaMode"] = "MASK";
  quad.material()["alphaCutoff"] = 0.3;
  EXPECT_THAT(quad.Load().warnings, IsEmpty());
  quad.material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  EXPECT_THAT(quad.Load().warnings, ElementsAre(HasSubstr("below 0.3 everywhere")));
}

TEST(GltfForeign, PicturesOfOneMaterialInDifferentPlaces) {
  Quad quad;
  quad.file["samplers"] = {{{"wrapS", 33071}}};
  quad.file["textures"].push_back({{"source", 0}, {"sampler", 0}});
  quad.material()["emissiveFactor"] = {1, 1, 1};
  quad.material()["emissiveTexture"] = {{"index", 1}};
  Scene scene = quad.Load();
  EXPECT_GE(quad.MaterialOf(scene).emission_texture, 0) << "within [0, 1] the wrapping is not used";
  EXPECT_THAT(scene.warnings, IsEmpty());
  quad.attributes()["TEXCOORD_0"] = quad.Add<float>(5126, "VEC2", {0, 0, 4, 0, 0, 4, 4, 4});
  scene = quad.Load();
  EXPECT_EQ(quad.MaterialOf(scene).emission_texture, -1);
  EXPECT_EQ(quad.MaterialOf(scene).emission, glm::vec3(0)) << "its factor is not alone";
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("wrapping")));
  quad.attributes()["TEXCOORD_1"] = quad.attributes()["TEXCOORD_0"];
  quad.material()["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  EXPECT_THAT(quad.Load().warnings, IsEmpty()) << "equal sets";
}

TEST(GltfForeign, TangentsThatContradictTheCoordinates) {
  Quad quad;
  quad.attributes()["NORMAL"] = quad.AddToAll({0, 0, 1});
  for (const auto& [tangent, is_said] : std::vector<std::pair<std::vector<float>, bool>>{
           {{1, 0, 0, 1}, false}, {{0, 1, 0, 1}, true}, {{1, 0, 0, -1}, true}}) {
    quad.attributes()["TANGENT"] = quad.AddToAll(tangent);
    quad.material().erase("normalTexture");
    EXPECT_THAT(quad.Load().warnings, IsEmpty());
    quad.material()["normalTexture"] = {{"index", 0}};
    EXPECT_THAT(quad.Load().warnings, SizeIs(is_said ? 1 : 0)) << tangent[0] << " " << tangent[3];
  }
}

TEST(GltfForeign, MeshoptOfANewerVersion) {
  Quad quad;
  quad.data += "\xa1...";
  json& view = quad.file["bufferViews"][0];
  view["extensions"]["KHR_meshopt_compression"] = {{"buffer", 0},     {"byteOffset", quad.data.size() - 4},
                                                   {"byteLength", 4}, {"byteStride", 12},
                                                   {"count", 4},      {"mode", "ATTRIBUTES"}};
  EXPECT_THAT(quad.Problem(),
              AllOf(HasSubstr("KHR_meshopt_compression: version 1 of its ATTRIBUTES is not supported: export")));
  quad.data[quad.data.size() - 4] = '\x11';
  EXPECT_THAT(quad.Problem(), HasSubstr("KHR_meshopt_compression: a buffer view is damaged"));
}

TEST(GltfForeign, APictureWithoutAName) {
  Quad quad;
  for (const json& image : {json{{"uri", ""}}, json::object()}) {
    quad.file["images"][0] = image;
    EXPECT_THAT(quad.Problem(), HasSubstr("images[0]: texture of material 'cloth'"));
    EXPECT_THAT(quad.Load(MissingTextures::grey).warnings, ElementsAre(HasSubstr("'images[0]'")));
  }
  quad.file["images"][0]["uri"] = "http://127.0.0.1:9/q.png";
  EXPECT_THAT(quad.Problem(), HasSubstr("nothing is fetched from the net"));
}

TEST(GltfForeign, ColoursThatAreNotNormalised) {
  Quad quad;
  quad.attributes()["COLOR_0"] =
      quad.Add<std::uint8_t>(5121, "VEC4", {255, 51, 0, 255, 255, 51, 0, 255, 255, 51, 0, 255, 255, 51, 0, 255});
  const Scene scene = quad.Load();
  EXPECT_FLOAT_EQ(scene.meshes.at(0).colors.at(0).y, 0.2f);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("not normalised")));
}

TEST(GltfForeign, AnUnusedMeshIsNotRead) {
  Quad quad;
  quad.file["textures"].push_back({{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  quad.file["materials"].push_back({{"emissiveTexture", {{"index", 1}}}});
  quad.file["meshes"].push_back(quad.file["meshes"][0]);
  quad.file["meshes"][1]["primitives"][0]["material"] = 1;
  EXPECT_THAT(quad.Load().meshes, SizeIs(1));
  quad.node()["mesh"] = 1;
  EXPECT_THAT(quad.Problem(), HasSubstr("materials[1]: KHR_texture_basisu"));
}

// Changes of a valid document, and what is said.
TEST(GltfForeign, ProblemsAreNamed) {
  const std::string encoded(200, 'A');
  for (const auto& [path, value, said] : std::vector<std::tuple<std::string, json, std::string>>{
           {"/bufferViews/0/byteStride", 4, "accessors[0]: the byteStride of bufferViews[0], 4, is less than the 12"},
           {"/accessors/0/sparse",
            {{"count", 9}, {"indices", {{"bufferView", 2}, {"componentType", 5123}}}, {"values", {{"bufferView", 0}}}},
            "accessors[0]: its sparse part has more rows"},
           {"/accessors/2/componentType", 5126, "accessors[2]: has indices of componentType 5126"},
           {"/accessors/2/componentType", 5122, "accessors[2]: has indices of componentType 5122"},
           {"/accessors/2/type", "VEC3", "accessors[2]: its type is not SCALAR"},
           {"/nodes/0/mesh", 0.7, "nodes[0]: 'mesh' is 0.7, not a whole number from 0 on"},
           {"/nodes/0/mesh", 1e300, "'mesh' is 1e+300, not a whole"},
           {"/nodes/0/mesh", -1, "'mesh' is -1, not a whole"},
           {"/nodes/0/mesh", "0", "'mesh' is \"0\", not a whole"},
           {"/nodes/0/mesh", 7, "nodes[0]: names meshes[7], which does not exist"},
           {"/nodes/0/children", {-1}, "nodes[0]: 'children' is -1, not a whole"},
           {"/materials/0/alphaCutoff", "x", "materials[0] is not glTF as its schema has it: type must be number"},
           {"/meshes/0/primitives/0/mode", 1, "has no triangles: its meshes are empty, or of points and lines"},
           {"/scenes/0/nodes", json::array(), "has no triangles: its scene shows no mesh"},
           {"/meshes/0/primitives/0/material", 7, "meshes[0]: names materials[7], which does not exist"},
           {"/accessors/2/count", 0, "has no triangles"},
           {"/asset", json::object(), "is not glTF: it has no asset.version"},
           {"/asset/version", "3.0", "is glTF of version '3.0': 1.0 and 2.0 are read"},
           {"/buffers/0/uri", "../other.bin", "the buffer '../other.bin': no such file"},
           {"/buffers/0/uri", "https://x.org/data.bin", "nothing is fetched from the net"},
           {"/buffers/0/uri", "p.bin", "the buffer 'p.bin': no such file"},  // not p.png
           {"/buffers/0/byteLength", 9999, "buffers[0] ('data.bin') is shorter than its byteLength: "},
           {"/buffers/0/uri", "data:x;base64,*" + encoded, "is not base64"},
           {"/buffers/0/uri", "data:" + encoded, "data URI without data: 'data:AAAAA"},
       }) {
    Quad quad;
    quad.file[json::json_pointer(path)] = value;
    const std::string problem = quad.Problem();
    EXPECT_THAT(problem, HasSubstr(said)) << path << " " << value;
    EXPECT_LT(problem.size(), 400u) << path;
  }
}

TEST(GltfForeign, BuffersOutsideAndOfOtherNames) {
  Quad quad;
  quad.folder.Write("sub/data.bin", quad.data);
  const auto load = [&](const std::string& uri) {
    quad.file["buffers"][0]["uri"] = uri;
    return quad.Load().warnings;
  };
  EXPECT_THAT(load("sub\\data.bin"), IsEmpty());
  EXPECT_THAT(load("SUB/../Data.BIN"), ElementsAre(HasSubstr("the buffer 'SUB/../Data.BIN' is taken from")));
  const std::string in = quad.folder.Write("in/m.gltf", [&] {
    quad.file["buffers"][0]["uri"] = "../sub/data.bin";
    return quad.file.dump();
  }());
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(in)); }), HasSubstr("must stay inside the folder"));
  quad.folder.Write("in/data.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(in)); }), HasSubstr("pointer of Git LFS"));
}

TEST(GltfForeign, FilesThatAreNotThere) {
  const Folder folder;
  for (const auto& [text, said] : {std::pair{"version https://git-lfs.github.com/spec/v1\noid", "'git lfs pull'"},
                                   {"<!DOCTYPE html><html>404</html>", "is a web page (HTML)"}}) {
    for (const char* name : {"m.gltf", "m.glb", "m.obj", "m.ply", "m.fbx", "m.dae", "m.stl"})
      EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(folder.Write(name, text))); }), HasSubstr(said)) << name;
    Quad quad;
    quad.folder.Write("p.png", text);
    EXPECT_THAT(quad.Problem(), HasSubstr(said));
  }
}

TEST(GltfForeign, DataUris) {
  Quad quad;
  const std::string zeros(quad.data.size() / 3 * 4 + 4, 'A');
  for (const std::string& uri :
       {"DATA:application/octet-stream;BASE64," + zeros,
        "data:;base64," + zeros.substr(0, 40) + "\n " + zeros.substr(40), "data:;base64,%41" + zeros.substr(1)}) {
    quad.file["buffers"][0]["uri"] = uri;
    EXPECT_THAT(quad.Problem(), HasSubstr("has no triangles: all are without area")) << uri.substr(0, 20);
  }
}

// assimp gives their materials black.
TEST(GltfForeign, TexturesOfGltf1) {
  Quad quad;
  quad.folder.Write("data.bin", quad.data);
  const Scene scene = LoadScene(WorldOf(quad.folder.Write("old.gltf", R"({"asset": {"version": "1.0"}, "scene": "s",
    "scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": ["m"]}}, "meshes": {"m": {"primitives": [{"attributes":
      {"POSITION": "p", "TEXCOORD_0": "u"}, "indices": "i", "material": "c", "mode": 4}]}},
    "buffers": {"b": {"byteLength": 92, "type": "arraybuffer", "uri": "data.bin"}},
    "bufferViews": {"v": {"buffer": "b", "byteOffset": 0, "byteLength": 92, "target": 34962}},
    "accessors": {"p": {"bufferView": "v", "byteOffset": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
      "u": {"bufferView": "v", "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC2"},
      "i": {"bufferView": "v", "byteOffset": 80, "componentType": 5123, "count": 6, "type": "SCALAR"}},
    "materials": {"c": {"values": {"diffuse": "t"}}}, "textures": {"t": {"source": "k", "sampler": "w"}},
    "samplers": {"w": {}}, "images": {"k": {"uri": "p.png"}}})")));
  EXPECT_GE(quad.MaterialOf(scene).texture, 0);
  EXPECT_EQ(quad.MaterialOf(scene).base_color, glm::vec3(1));
}

// What follows the length in a binary file's header is not its own.
TEST(GltfForeign, BytesAfterABinaryFile) {
  Quad quad;
  quad.file["buffers"][0] = {{"byteLength", quad.data.size()}};
  std::string text = quad.file.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto put = [&](std::uint32_t word) { bytes.append(reinterpret_cast<const char*>(&word), 4); };
  put(2), put(static_cast<std::uint32_t>(28 + text.size() + quad.data.size()));
  put(static_cast<std::uint32_t>(text.size())), put(0x4e4f534a), bytes += text;
  put(static_cast<std::uint32_t>(quad.data.size())), put(0x004e4942), bytes += quad.data;
  put(1u << 30), put(0x58585858);
  EXPECT_THAT(LoadScene(WorldOf(quad.folder.Write("m.glb", bytes))).meshes, SizeIs(1));
}

}  // namespace
}  // namespace sim::test
