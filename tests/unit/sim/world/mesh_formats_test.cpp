// The same small world through glTF, GLB and FBX: node transforms, linear colour factors, textures inside the file.
#include <assimp/material.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "sim/world/fbx_text.h"
#include "sim/world/scene.h"
#include "sim/world/xml_text.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string Base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8) | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[(group >> (18 - 6 * k)) & 63u];
  }
  return text;
}

template <class T>
void Append(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A triangle with colours and texture coordinates under two nodes: the outer moves by (0, 0, 5), the inner scales by 2.
std::string Gltf(const std::string& picture) {
  std::string data;
  Append<float>(data, {0, 0, 0, 1, 0, 0, 0, 1, 0});                    // positions, 36 bytes
  Append<float>(data, {0, 0, 1, 0, 0, 1});                             // texture coordinates, 24
  Append<float>(data, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 1, 1, 1});  // colours, 36
  Append<std::uint16_t>(data, {0, 1, 2, 0});                           // indices, 6 of 8
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"translation": [0, 0, 5], "children": [1]}, {"scale": [2, 2, 2], "mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "indices": 3, "material": 0}]}],
    "materials": [{"name": "paint", "emissiveFactor": [0.5, 0, 0.25],
      "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 1, 1], "baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"mimeType": "image/png", "uri": "data:image/png;base64,)" +
         Base64(picture) + R"("}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
      {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"},
      {"bufferView": 3, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
      {"buffer": 0, "byteOffset": 60, "byteLength": 36}, {"buffer": 0, "byteOffset": 96, "byteLength": 6}],
    "buffers": [{"byteLength": )" +
         std::to_string(data.size()) + R"(, "uri": "data:application/octet-stream;base64,)" + Base64(data) + R"("}]})";
}

TEST(MeshFormats, GltfWithTextureInside) {
  const Folder folder;
  const Scene scene = LoadScene(WorldOf(folder.Write("triangle.gltf", Gltf(EncodeNoise(".png", 8, 4)))));
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.meshes, SizeIs(1));
  const Mesh& mesh = scene.meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(0, 0, 5), glm::vec3(2, 0, 5), glm::vec3(0, 2, 5)));
  EXPECT_THAT(mesh.uvs,
              ElementsAre(glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)));  // glTF's v points down, as ours
  EXPECT_THAT(mesh.colors, ElementsAre(glm::vec3(0.5f), glm::vec3(0.5f), glm::vec3(1.0f)));  // linear
  const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
  EXPECT_EQ(material.base_color, glm::vec3(0.25f, 0.5f, 1.0f));
  EXPECT_EQ(material.emission, glm::vec3(0.5f, 0.0f, 0.25f));
  ASSERT_EQ(material.texture, 0);
  EXPECT_EQ(scene.textures[0].width(), 8);
  EXPECT_EQ(scene.textures[0].height(), 4);
}

TEST(MeshFormats, TruncatedTextureInside) {
  const Folder folder;
  const std::string picture = EncodeNoise(".png", 8, 4);
  const WorldDescription world = WorldOf(folder.Write("cut.gltf", Gltf(picture.substr(0, picture.size() / 2))));
  EXPECT_THAT(ProblemsOf([&] { LoadScene(world); }),
              ElementsAre(testing::AllOf(HasSubstr("cut.gltf"), HasSubstr("truncated PNG"), HasSubstr("paint"))));
}

// A triangle at (1, 2, 3) + {0, x, y}, blue, under a node that moves it by (10, 0, 0).
aiScene* TriangleForExport() {
  auto* scene = new aiScene;
  auto* mesh = new aiMesh;
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = 3;
  mesh->mVertices = new aiVector3D[3]{{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};
  mesh->mNormals = new aiVector3D[3]{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh->mNumFaces = 1;
  mesh->mFaces = new aiFace[1];
  mesh->mFaces[0].mNumIndices = 3;
  mesh->mFaces[0].mIndices = new unsigned[3]{0, 1, 2};
  scene->mNumMeshes = 1;
  scene->mMeshes = new aiMesh* [1] { mesh };
  auto* material = new aiMaterial;
  const aiColor3D blue(0.125f, 0.25f, 0.75f);
  material->AddProperty(&blue, 1, AI_MATKEY_COLOR_DIFFUSE);
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { material };
  scene->mRootNode = new aiNode("root");
  auto* child = new aiNode("child");
  child->mTransformation = aiMatrix4x4({1, 1, 1}, aiQuaternion(), {10, 0, 0});
  child->mNumMeshes = 1;
  child->mMeshes = new unsigned[1]{0};
  scene->mRootNode->addChildren(1, &child);
  return scene;
}

// unit: of the file [m].
void ExpectTriangle(const Scene& loaded, const std::string& name, bool has_material, float unit = 1) {
  ASSERT_THAT(loaded.meshes, SizeIs(1)) << name;
  ASSERT_THAT(loaded.meshes[0].positions, SizeIs(3)) << name;
  for (const glm::vec3& p : {glm::vec3(11, 2, 3), glm::vec3(12, 2, 3), glm::vec3(11, 3, 3)}) {
    bool found = false;
    for (const glm::vec3& q : loaded.meshes[0].positions) found = found || glm::distance(unit * p, q) < 1e-5f * unit;
    EXPECT_TRUE(found) << name << ": " << p.x << " " << p.y << " " << p.z;
  }
  if (!has_material) return;
  const glm::vec3 color = loaded.materials[static_cast<std::size_t>(loaded.meshes[0].material)].base_color;
  EXPECT_NEAR(color.x, 0.125f, 1e-5) << name;
  EXPECT_NEAR(color.z, 0.75f, 1e-5) << name;
}

// Warning about a feature that is not rendered, once for each kind.
TEST(MeshFormats, BumpMapsAreSaid) {
  const Folder folder;
  folder.Write("bumps.png", EncodeColor(".png", 9, 9, 9));
  const std::unique_ptr<aiScene> scene(TriangleForExport());
  const aiString picture("bumps.png");
  scene->mMaterials[0]->AddProperty(&picture, AI_MATKEY_TEXTURE(aiTextureType_HEIGHT, 0));
  Assimp::Exporter exporter;
  const std::string file = (folder.path() / "t.fbx").string();
  ASSERT_EQ(exporter.Export(scene.get(), "fbxa", file), AI_SUCCESS) << exporter.GetErrorString();
  EXPECT_THAT(LoadScene(WorldOf(file)).warnings, ElementsAre(HasSubstr("bump maps (heights) are not rendered")));
}

TEST(MeshFormats, AsAssimpWritesThem) {
  const Folder folder;
  const std::unique_ptr<aiScene> scene(TriangleForExport());
  for (const auto& [format, name] :
       {std::pair{"glb2", "t.glb"}, {"fbxa", "t.fbx"}, {"ply", "t.ply"}, {"obj", "t.obj"}}) {
    Assimp::Exporter exporter;
    const std::string file = (folder.path() / name).string();
    ASSERT_EQ(exporter.Export(scene.get(), format, file), AI_SUCCESS) << exporter.GetErrorString();
    // The unit of assimp's FBX is a centimetre.
    ExpectTriangle(LoadScene(WorldOf(file)), name, std::string(format) != "ply", format[0] == 'f' ? 0.01f : 1.0f);
  }
}

// Binary FBX by hand, since assimp 5.2 cannot read its own. A record is: end offset, number and size of the properties,
// name, properties, nested records and 13 zeros after the last of them.
struct Record {
  std::string name;
  std::vector<std::string> properties;
  std::vector<Record> nested;
};

std::string Long(std::int64_t value) {
  std::string bytes = "L";
  Append(bytes, {value});
  return bytes;
}
std::string Text(const std::string& value) {
  std::string bytes = "S";
  Append(bytes, {static_cast<std::uint32_t>(value.size())});
  return bytes + value;
}
std::string Int(std::int32_t value) {
  std::string bytes = "I";
  Append(bytes, {value});
  return bytes;
}
std::string Real(double value) {
  std::string bytes = "D";
  Append(bytes, {value});
  return bytes;
}
template <class T>
std::string Array(char type, std::initializer_list<T> values) {
  std::string bytes(1, type);
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  Append(bytes, {static_cast<std::uint32_t>(values.size()), 0u, size});
  Append(bytes, values);
  return bytes;
}

void AppendRecord(const Record& record, std::string& file) {
  std::string properties;
  for (const std::string& property : record.properties) properties += property;
  const std::size_t begin = file.size();
  Append<std::uint32_t>(
      file, {0u, static_cast<std::uint32_t>(record.properties.size()), static_cast<std::uint32_t>(properties.size())});
  file += static_cast<char>(record.name.size());
  file += record.name + properties;
  for (const Record& nested : record.nested) AppendRecord(nested, file);
  if (!record.nested.empty()) file.append(13, '\0');
  const auto end = static_cast<std::uint32_t>(file.size());
  std::memcpy(&file[begin], &end, sizeof end);
}

Record Vector(const std::string& name, double x, double y, double z) {
  return {"P", {Text(name), Text("Vector3D"), Text(""), Text("A"), Real(x), Real(y), Real(z)}, {}};
}

// Global setting of FBX: the unit in centimetres, and the axes that point up and to the front.
Record Setting(const std::string& name, int value) {
  return {"P", {Text(name), Text("int"), Text("Integer"), Text(""), Int(value)}, {}};
}

std::string FbxTriangle(const std::vector<Record>& settings,
                        const Record& color = Vector("DiffuseColor", 0.125, 0.25, 0.75)) {
  const std::string separator("\0\1", 2);
  const std::vector<Record> records = {
      {"FBXHeaderExtension", {}, {{"FBXVersion", {Int(7400)}, {}}}},
      {"GlobalSettings", {}, {{"Properties70", {}, settings}}},
      {"Objects",
       {},
       {{"Geometry",
         {Long(1), Text("triangle" + separator + "Geometry"), Text("Mesh")},
         {{"Vertices", {Array<double>('d', {1, 2, 3, 2, 2, 3, 1, 3, 3})}, {}},
          {"PolygonVertexIndex", {Array<std::int32_t>('i', {0, 1, -3})}, {}},
          {"LayerElementMaterial",
           {Int(0)},
           {{"MappingInformationType", {Text("AllSame")}, {}},
            {"ReferenceInformationType", {Text("IndexToDirect")}, {}},
            {"Materials", {Array<std::int32_t>('i', {0})}, {}}}},
          {"Layer",
           {Int(0)},
           {{"LayerElement", {}, {{"Type", {Text("LayerElementMaterial")}, {}}, {"TypedIndex", {Int(0)}, {}}}}}}}},
        {"Model",
         {Long(2), Text("node" + separator + "Model"), Text("Mesh")},
         {{"Properties70", {}, {Vector("Lcl Translation", 10, 0, 0)}}}},
        {"Material",
         {Long(3), Text("paint" + separator + "Material"), Text("")},
         {{"ShadingModel", {Text("lambert")}, {}}, {"Properties70", {}, {color}}}}}},
      {"Connections",
       {},
       {{"C", {Text("OO"), Long(2), Long(0)}, {}},
        {"C", {Text("OO"), Long(1), Long(2)}, {}},
        {"C", {Text("OO"), Long(3), Long(2)}, {}}}}};
  std::string file("Kaydara FBX Binary  \0\x1a\0", 23);
  Append<std::uint32_t>(file, {7400});
  for (const Record& record : records) AppendRecord(record, file);
  file.append(13, '\0');
  return file;
}

TEST(MeshFormats, BinaryFbx) {
  const Folder folder;
  const auto load = [&](const std::vector<Record>& settings) {
    return LoadScene(WorldOf(folder.Write("binary.fbx", FbxTriangle(settings))));
  };
  ExpectTriangle(load({Vector("Unused", 0, 0, 0)}), "binary.fbx", true, 0.01f);
  const Record metre{"P", {Text("UnitScaleFactor"), Text("double"), Text("Number"), Text(""), Real(100)}, {}};
  ExpectTriangle(load({metre}), "binary.fbx", true);
  // z up, the front towards -y: (x, y, z) becomes (x, z, -y).
  const Scene z_up = load({metre, Setting("UpAxis", 2), Setting("UpAxisSign", 1), Setting("FrontAxis", 1),
                           Setting("FrontAxisSign", -1), Setting("CoordAxis", 0), Setting("CoordAxisSign", 1)});
  EXPECT_THAT(z_up.meshes.at(0).positions, testing::Contains(glm::vec3(11, 3, -2)));
}

// Physical materials without a diffuse colour, and materials without any.
TEST(MeshFormats, FbxMaterialsWithoutADiffuseColour) {
  const Folder folder;
  const auto load = [&](const std::string& name) {
    return LoadScene(WorldOf(folder.Write("t.fbx", FbxTriangle({Setting("UpAxis", 1)}, Vector(name, 0.5, 0.25, 0)))));
  };
  const auto color = [](const Scene& scene) {
    return scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).material)).base_color;
  };
  for (const std::string name : {"Maya|baseColor", "3dsMax|Parameters|base_color"}) {
    const Scene scene = load(name);
    EXPECT_EQ(color(scene), glm::vec3(0.5f, 0.25f, 0)) << name;
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
  const Scene none = load("Weight");
  EXPECT_EQ(color(none), glm::vec3(1));
  EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("a material without a colour is white")));
}

// Properties that assimp leaves out and that change the picture, in both encodings.
TEST(MeshFormats, FbxWarnings) {
  const Folder folder;
  const auto warnings = [&](const std::vector<Record>& settings) {
    return LoadScene(WorldOf(folder.Write("t.fbx", FbxTriangle(settings)))).warnings;
  };
  EXPECT_THAT(warnings({Setting("WrapModeU", 0), Setting("Show", 1), Setting("UnShow", 0)}), testing::IsEmpty());
  EXPECT_THAT(warnings({Setting("WrapModeV", 1)}), testing::ElementsAre(testing::HasSubstr("WrapMode 1")));
  EXPECT_THAT(warnings({Setting("Show", 0)}), testing::ElementsAre(testing::HasSubstr("hidden objects are drawn")));
  EXPECT_THAT(warnings({{"P", {Text("LodGroup")}, {}}}), testing::ElementsAre(testing::HasSubstr("levels of detail")));
  const std::string text = "; FBX 7.4.0 project file\nP: \"Visibility\", \"Visibility\", \"\", \"A\", 0\n";
  EXPECT_THAT(FbxWarnings(text), testing::ElementsAre("hidden objects are drawn"));
  EXPECT_THAT(
      FbxWarnings("P: \"Visibility\", \"Visibility\", \"\", \"A\", 1\nP: \"WrapModeU\", \"enum\", \"\", \"\",0"),
      testing::IsEmpty());
  const auto layer = [](const std::string& mapping) {
    return FbxWarnings("\nLayerElementUV: 0 {\nMappingInformationType: \"" + mapping +
                       "\"\n}\nType: \"LayerElementNormal\"\nMappingInformationType: \"AllSame\"");
  };
  EXPECT_THAT(layer("ByPolygon"), testing::ElementsAre(testing::HasSubstr("LayerElementUV of whole faces")));
  EXPECT_THAT(layer("ByPolygonVertex"), testing::IsEmpty());
  EXPECT_THAT(FbxWarnings(std::string(
                  "Kaydara FBX Binary \x11LayerElementColor\x16MappingInformationTypeS\x07\0\0\0AllSame", 72)),
              testing::SizeIs(1));
  EXPECT_THAT(FbxWarnings(std::string("Kaydara FBX Binary  S\x04\0\0\0Show", 29)), testing::IsEmpty()) << "cut off";
}

// COLLADA of 3ds Max: a coordinate set with a name that is bound nowhere, and blanks ahead of numbers.
TEST(MeshFormats, ColladaOfOtherPrograms) {
  const Folder folder;
  folder.Write("paint.png", EncodeNoise(".png", 8, 4));
  const std::string text = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.5"/><up_axis>Y_UP</up_axis></asset>
<library_images><image id="i"><init_from> paint.png </init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
  <newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
  <newparam sid="p"><sampler2D><source>s</source></sampler2D></newparam>
  <technique sid="common"><lambert><emission><color> 0.25 0 0 1</color></emission>
  <diffuse><texture texture="p" texcoord="CHANNEL1"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
  <source id="x"><float_array id="xa" count="9"> 0 0 0 2 0 0 0 2 0</float_array><technique_common>
    <accessor source="#xa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <source id="t"><float_array id="ta" count="6">0 0 1 0 0 1</float_array><technique_common>
    <accessor source="#ta" count="3" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#x"/></vertices>
  <triangles material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
    <input semantic="TEXCOORD" source="#t" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n"><instance_geometry url="#g"><bind_material><technique_common>
  <instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>
)";
  const Scene scene = LoadScene(WorldOf(folder.Write("model.dae", text)));
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.meshes, SizeIs(1));
  EXPECT_THAT(scene.meshes[0].positions, testing::Contains(glm::vec3(1, 0, 0))) << "half a metre a unit";
  EXPECT_THAT(scene.meshes[0].uvs, SizeIs(3));
  const Material& material = scene.materials.at(static_cast<std::size_t>(scene.meshes[0].material));
  EXPECT_GE(material.texture, 0);
  EXPECT_EQ(material.base_color, glm::vec3(1));
  EXPECT_FLOAT_EQ(material.emission.x, 0.25f);
}

// Chunk of a 3DS file.
std::string Chunk(std::uint16_t id, const std::string& content) {
  std::string bytes;
  Append<std::uint16_t>(bytes, {id});
  Append<std::uint32_t>(bytes, {static_cast<std::uint32_t>(content.size() + 6)});
  return bytes + content;
}

// A triangle of grey 128; `map`: its picture, if any.
std::string ThreeDs(const std::string& map) {
  const std::string name("m\0", 2);
  std::string corners, uvs, faces;
  Append<std::uint16_t>(corners, {3});
  Append<float>(corners, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  Append<std::uint16_t>(uvs, {3});
  Append<float>(uvs, {0, 0, 1, 0, 0, 1});
  Append<std::uint16_t>(faces, {1, 0, 1, 2, 7});
  std::string of_faces = name;
  Append<std::uint16_t>(of_faces, {1, 0});
  std::string paint = Chunk(0xa000, name) + Chunk(0xa020, Chunk(0x0011, "\x80\x80\x80"));
  if (!map.empty()) paint += Chunk(0xa200, Chunk(0x0030, std::string("d\0", 2)) + Chunk(0xa300, map + '\0'));
  const std::string mesh =
      Chunk(0x4100, Chunk(0x4110, corners) + Chunk(0x4140, uvs) + Chunk(0x4120, faces + Chunk(0x4130, of_faces)));
  return Chunk(0x4d4d, Chunk(0x3d3d, Chunk(0xafff, paint) + Chunk(0x4000, name + mesh)));
}

// 3DS: the picture at full strength takes the colour's place.
TEST(MeshFormats, APictureOf3dsTakesTheColoursPlace) {
  const Folder folder;
  folder.Write("paint.png", EncodeNoise(".png", 8, 4));
  for (const bool painted : {true, false}) {
    const Scene scene = LoadScene(WorldOf(folder.Write("model.3ds", ThreeDs(painted ? "paint.png" : ""))));
    ASSERT_THAT(scene.meshes, SizeIs(1));
    const Material& material = scene.materials.at(static_cast<std::size_t>(scene.meshes[0].material));
    EXPECT_EQ(material.texture >= 0, painted);
    EXPECT_EQ(material.base_color.x == 1, painted) << material.base_color.x;
  }
}

// A triangle in the plane z = 1 of COLLADA; `effect` is its shader, `extra` its skin's controller.
std::string ColladaTriangle(const std::string& up, const std::string& effect, const std::string& nodes,
                            const std::string& extra = "") {
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>"
         "<up_axis>" +
         up + "</up_axis></asset><library_effects><effect id='e'><profile_COMMON><technique sid='c'>" + effect +
         "</technique></profile_COMMON></effect></library_effects><library_materials><material id='m'>"
         "<instance_effect url='#e'/></material></library_materials><library_geometries><geometry id='g'><mesh>"
         "<source id='x'><float_array id='xa' count='9'>0 0 1 1 0 1 0 1 1</float_array><technique_common>"
         "<accessor source='#xa' count='3' stride='3'><param name='X' type='float'/><param name='Y' type='float'/>"
         "<param name='Z' type='float'/></accessor></technique_common></source><vertices id='v'>"
         "<input semantic='POSITION' source='#x'/></vertices><triangles material='m' count='1'>"
         "<input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
         "</library_geometries>" +
         extra + "<library_visual_scenes><visual_scene id='w'>" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

constexpr char kInstance[] =
    "<node id='n'><instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='m' "
    "target='#m'/></technique_common></bind_material></instance_geometry></node>";

// A mesh without a material is white, not as the file's first material is.
TEST(MeshFormats, ColladaMeshesWithoutAMaterial) {
  const Folder folder;
  const std::string bare = "<node id='o'><translate>0 0 1</translate><instance_geometry url='#g'/></node>",
                    red = "<lambert><diffuse><color>1 0 0 1</color></diffuse></lambert>";
  std::string text = ColladaTriangle("Y_UP", red, bare + kInstance);
  for (const std::string name : {"<triangles material='", "symbol='"}) text.insert(text.find(name) + name.size(), "s");
  const Scene scene = LoadScene(WorldOf(folder.Write("m.dae", text)));
  std::vector<glm::vec3> colors;
  for (const Mesh& mesh : scene.meshes)
    colors.push_back(scene.materials.at(static_cast<std::size_t>(mesh.material)).base_color);
  EXPECT_THAT(colors, testing::UnorderedElementsAre(glm::vec3(1), glm::vec3(1, 0, 0)));
}

// Blanks about the axis; shaders that glow and have no diffuse colour are black otherwise.
TEST(MeshFormats, ColladaAxisWithBlanksAndShadersThatGlowAlone) {
  for (const std::string shader : {"lambert", "constant", "phong"}) {
    const Folder folder;
    const std::string glow = "<" + shader + "><emission><color>1 0 0.5 1</color></emission></" + shader + ">";
    const Scene scene = LoadScene(WorldOf(folder.Write("m.dae", ColladaTriangle(" Z_UP\n", glow, kInstance))));
    EXPECT_THAT(scene.meshes.at(0).positions, testing::Contains(glm::vec3(0, 1, -1))) << "z is up";
    const Material& material = scene.materials.at(static_cast<std::size_t>(scene.meshes[0].material));
    EXPECT_EQ(material.base_color, glm::vec3(0)) << shader;
    EXPECT_EQ(material.emission, glm::vec3(1, 0, 0.5f)) << shader;
  }
}

// Bind shape matrix (twice the size), inverse bind matrix (x less 1) and the joint's place (y 3) all count.
TEST(MeshFormats, SkinsStandWhereTheirJointsAre) {
  const auto source = [](const std::string& id, const std::string& array, const std::string& param,
                         const std::string& values, int stride) {
    return "<source id='" + id + "'><" + array + " id='" + id + "a' count='" + std::to_string(stride) + "'>" + values +
           "</" + array + "><technique_common><accessor source='#" + id + "a' count='1' stride='" +
           std::to_string(stride) + "'><param name='P' type='" + param + "'/></accessor></technique_common></source>";
  };
  const std::string skin =
      "<library_controllers><controller id='k'><skin source='#g'>"
      "<bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</bind_shape_matrix>" +
      source("j", "Name_array", "name", "J", 1) +
      source("b", "float_array", "float4x4", "1 0 0 -1 0 1 0 0 0 0 1 0 0 0 0 1", 16) +
      source("u", "float_array", "float", "1", 1) +
      "<joints><input semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' source='#b'/></joints>"
      "<vertex_weights count='3'><input semantic='JOINT' source='#j' offset='0'/>"
      "<input semantic='WEIGHT' source='#u' offset='1'/><vcount>1 1 1</vcount><v>0 0 0 0 0 0</v></vertex_weights>"
      "</skin></controller></library_controllers>";
  const std::string nodes =
      "<node id='J' sid='J' type='JOINT'><translate>0 3 0</translate></node><node id='n'><instance_controller "
      "url='#k'><skeleton>#J</skeleton></instance_controller></node>";
  const Folder folder;
  const Scene scene = LoadScene(WorldOf(folder.Write("m.dae", ColladaTriangle("Y_UP", "<lambert/>", nodes, skin))));
  EXPECT_THAT(scene.meshes.at(0).positions,
              testing::UnorderedElementsAre(glm::vec3(-1, 3, 2), glm::vec3(1, 3, 2), glm::vec3(-1, 5, 2)));
}

// A solid without facets, corners on one line and a missing normal; a file that breaks off.
TEST(MeshFormats, StlByHand) {
  const Folder folder;
  const auto file = [&](const std::string& end) {
    return folder.Write("m.stl",
                        "solid none\rendsolid\rsolid b\rfacet outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 "
                        "endloop endfacet\r" +
                            end);
  };
  const Scene scene = LoadScene(WorldOf(file("endsolid b\r")));
  ASSERT_THAT(scene.meshes, SizeIs(1));
  EXPECT_EQ(scene.meshes[0].name, "b");
  EXPECT_THAT(scene.meshes[0].triangles, SizeIs(1));
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(file(""))); }), HasSubstr("ends too early"));
  const std::string outside = "solidx facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n";
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(WorldOf(folder.Write("m.stl", outside))); }),
              HasSubstr("outside of a solid"));
}

TEST(MeshFormats, ColladaWarnings) {
  const auto warnings = [](std::string_view text) {
    std::vector<std::string> all;
    ColladaForAssimp(text, all);
    return all;
  };
  EXPECT_THAT(warnings("<wrap_s>WRAP</wrap_s>"), IsEmpty());
  EXPECT_THAT(warnings("<wrap_t>BORDER</wrap_t>"), testing::ElementsAre(testing::HasSubstr("texels at its edge")));
  const std::string bind = "<bind_vertex_input\tsemantic = 'UV'\n input_semantic='TEXCOORD' input_set='1'/>",
                    other = "<bind_vertex_input semantic='UV' input_semantic='TEXCOORD' input_set='0'/>";
  EXPECT_THAT(warnings(bind + bind), IsEmpty());
  EXPECT_THAT(warnings(bind + other), testing::ElementsAre(testing::HasSubstr("several sets")));
  const std::string sets = "<input semantic='TEXCOORD' set='0'/><input semantic='TEXCOORD' set='1'/><p>";
  std::vector<std::string> none;
  EXPECT_EQ(ColladaForAssimp(sets + bind + "<texture\ntexcoord='UV'/>", none),
            sets + bind + "<texture\ntexcoord='1'/>");
  EXPECT_THAT(none, IsEmpty());
}

// A source of three rows of floats.
std::string ColladaSource(const std::string& id, const std::string& axes, const std::string& numbers) {
  std::string text = "<source id='" + id + "'><float_array id='" + id + "a' count='" + std::to_string(3 * axes.size()) +
                     "'>" + numbers + "</float_array><technique_common>" + "<accessor source='#" + id +
                     "a' count='3' stride='" + std::to_string(axes.size()) + "'>";
  for (const char axis : axes) text += std::string("<param name='") + axis + "' type='float'/>";
  return text + "</accessor></technique_common></source>";
}

// A triangle with a picture, texture coordinates from 0 to 2. With controllers, the one named k is its instance.
std::string ColladaPicture(const std::string& version, const std::string& effect, const std::string& controllers = "") {
  const std::string image = version == "1.5.0" ? "<ref>paint.png</ref>" : "paint.png";
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='" + version +
         "'><library_images><image id='i'><init_from>" + image + "</init_from></image></library_images>" +
         "<library_effects><effect id='e'>" + effect + "</effect></library_effects><library_materials>" +
         "<material id='m'><instance_effect url='#e'/></material></library_materials><library_geometries>" +
         "<geometry id='g'><mesh>" + ColladaSource("x", "XYZ", "0 0 0 2 0 0 0 2 0") +
         ColladaSource("t", "ST", "0 0 2 0 0 2") +
         "<vertices id='v'><input semantic='POSITION' source='#x'/></vertices><triangles material='m' count='1'>"
         "<input semantic='VERTEX' source='#v' offset='0'/><input semantic='TEXCOORD' source='#t' offset='1' set='0'/>"
         "<p>0 0 1 1 2 2</p></triangles></mesh></geometry></library_geometries>" +
         controllers + "<library_visual_scenes><visual_scene id='w'><node>" +
         (controllers.empty() ? "<instance_geometry url='#g'>" : "<instance_controller url='#k'>") +
         "<bind_material><technique_common><instance_material symbol='m' target='#m'/></technique_common>"
         "</bind_material>" +
         (controllers.empty() ? "</instance_geometry>" : "</instance_controller>") +
         "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

// Parameters of effects as 1.4 and 1.5 may have them, with a sampler's wrapping.
std::vector<std::string> EffectForms(const std::string& wrap) {
  const std::string surface =
                        "<newparam sid='s'><surface type='2D'><init_from>i</init_from></surface></newparam>"
                        "<newparam sid='p'><sampler2D><source>s</source>" +
                        wrap + "</sampler2D></newparam>",
                    shader = "<lambert><diffuse><texture texture='p' texcoord='UV'/></diffuse></lambert></technique>",
                    instance =
                        "<newparam sid='p'><sampler2D><instance_image url='#i'/>" + wrap + "</sampler2D></newparam>";
  return {"<profile_COMMON>" + surface + "<technique sid='c'>" + shader + "</profile_COMMON>",
          surface + "<profile_COMMON><technique sid='c'>" + shader + "</profile_COMMON>",
          "<profile_COMMON><technique sid='c'>" + surface + shader + "</profile_COMMON>",
          "<profile_COMMON>" + instance + "<technique sid='c'>" + shader + "</profile_COMMON>"};
}

TEST(MeshFormats, ColladaPicturesAndTheirWrapping) {
  const Folder folder;
  folder.Write("paint.png", EncodeNoise(".png", 8, 4));
  for (const auto& [mode, u_at_2] : {std::pair{"WRAP", 2.0f}, {"MIRROR", 0.0625f}, {"CLAMP", 0.9375f}}) {
    const std::vector<std::string> forms = EffectForms(std::string("<wrap_s>") + mode + "</wrap_s>");
    for (const std::string& form : forms) {
      const std::string version = &form == &forms.back() ? "1.5.0" : "1.4.1";
      const Scene scene = LoadScene(WorldOf(folder.Write("m.dae", ColladaPicture(version, form))));
      EXPECT_THAT(scene.warnings, IsEmpty()) << mode << form;
      ASSERT_THAT(scene.meshes, SizeIs(1));
      ASSERT_THAT(scene.textures, SizeIs(1)) << form;
      const Mesh& mesh = scene.meshes[0];
      for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
        if (mesh.positions[i] != glm::vec3(2, 0, 0)) continue;
        EXPECT_EQ(mesh.uvs[i].x, u_at_2) << mode << " (edges are half a texel of 8 inside)";
      }
      EXPECT_THAT(mesh.positions, testing::Contains(glm::vec3(2, 0, 0)));
    }
  }
}

// The base shape of a morph; its targets are said where they have a weight.
TEST(MeshFormats, ColladaMorphsAreTheirBase) {
  const Folder folder;
  folder.Write("paint.png", EncodeNoise(".png", 8, 4));
  for (const bool is_moved : {false, true}) {
    const std::string morph =
        "<library_controllers><controller id='k'><morph source='#g' method='NORMALIZED'><source id='n'>"
        "<IDREF_array id='na' count='1'>g</IDREF_array><technique_common><accessor source='#na' count='1' stride='1'>"
        "<param name='M' type='IDREF'/></accessor></technique_common></source><source id=\"u\">"
        "<float_array id='ua' count='1'>" +
        std::string(is_moved ? "0.5" : "0.0") +
        "</float_array><technique_common><accessor source='#ua' count='1' stride='1'>"
        "<param name='W' type='float'/></accessor></technique_common></source><targets><input semantic='MORPH_TARGET' "
        "source='#n'/><input semantic='MORPH_WEIGHT' source='#u'/></targets></morph></controller>"
        "</library_controllers>";
    const Scene scene = LoadScene(WorldOf(folder.Write("m.dae", ColladaPicture("1.4.1", EffectForms("")[0], morph))));
    ASSERT_THAT(scene.meshes, SizeIs(1));
    EXPECT_THAT(scene.meshes[0].positions, testing::Contains(glm::vec3(2, 0, 0)));
    if (is_moved) {
      EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("morph targets are left out")));
    } else {
      EXPECT_THAT(scene.warnings, IsEmpty());
    }
  }
}

TEST(MeshFormats, ColladaWithSkewIsRefused) {
  const Folder folder;
  const std::string node = "<node id='n'><skew>45 0 1 0 1 0 0</skew><instance_geometry url='#g'/></node>";
  const WorldDescription world = WorldOf(folder.Write("m.dae", ColladaTriangle("Y_UP", "<lambert/>", node)));
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(world); }), HasSubstr("<skew>, which is not read"));
  std::vector<std::string> none;
  EXPECT_THAT(ColladaForAssimp("<!-- <a/> <skew>1</skew> -->", none), HasSubstr("skew")) << "a comment";
}

// COLLADA with two sets of texture coordinates: the bound one counts, by its number among those of the polygons.
TEST(MeshFormats, ColladaWithTwoSets) {
  const auto first_corners = [](const std::string& name, int bound, int set, std::vector<std::string>* warnings) {
    const Folder folder;
    folder.Write("paint.png", EncodeNoise(".png", 8, 4));
    const std::string text =
        "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
        "<library_images><image id='i'><init_from>paint.png</init_from></image></library_images><library_effects>"
        "<effect id='e'><profile_COMMON><newparam sid='s'><surface type='2D'><init_from>i</init_from></surface>"
        "</newparam><newparam sid='p'><sampler2D><source>s</source></sampler2D></newparam><technique sid='c'><lambert>"
        "<diffuse><texture texture='p' texcoord='" +
        name +
        "'/></diffuse></lambert></technique></profile_COMMON>"
        "</effect></library_effects><library_materials><material id='m'><instance_effect url='#e'/></material>"
        "</library_materials><library_geometries><geometry id='g'><mesh>" +
        ColladaSource("x", "XYZ", "0 0 0 1 0 0 0 1 0") + ColladaSource("t", "ST", "0 0 1 0 0 1") +
        ColladaSource("l", "ST", "5 5 5 5 5 5") +
        "<vertices id='v'><input semantic='POSITION' source='#x'/></vertices><triangles material='m' count='1'>"
        "<input semantic='VERTEX' source='#v' offset='0'/><input semantic='TEXCOORD' source='#t' offset='1' set='" +
        std::to_string(set) + "'/><input semantic='TEXCOORD' source='#l' offset='2' set='" + std::to_string(set + 1) +
        "'/><p>0 0 0 1 1 1 2 2 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
        "<visual_scene id='w'><node><instance_geometry url='#g'><bind_material><technique_common>"
        "<instance_material symbol='m' target='#m'>" +
        (bound < 0 ? ""
                   : "<bind_vertex_input semantic='" + name + "' input_semantic='TEXCOORD' input_set='" +
                         std::to_string(bound) + "'/>") +
        "</instance_material></technique_common></bind_material></instance_geometry></node></visual_scene>"
        "</library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
    const Scene scene = LoadScene(WorldOf(folder.Write("model.dae", text)));
    if (warnings != nullptr) *warnings = scene.warnings;
    return scene.meshes.at(0).uvs.at(1);
  };
  EXPECT_EQ(first_corners("CHANNEL1", 1, 1, nullptr), glm::vec2(1, 1));
  EXPECT_EQ(first_corners("Atlas_2048", 0, 0, nullptr), glm::vec2(1, 1));
  EXPECT_EQ(first_corners("UVMap", 1, 0, nullptr), glm::vec2(5, -4)) << "the second";
  std::vector<std::string> warnings;
  EXPECT_EQ(first_corners("map1", -1, 0, &warnings), glm::vec2(1, 1));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("bound to no set")));
}

// X3D with a picture by a list of URLs, as Blender writes it; textures repeat unless they say otherwise.
TEST(MeshFormats, X3dPictures) {
  const Folder folder;
  folder.Write("paint.png", EncodeNoise(".png", 8, 4));
  for (const std::string url : {R"(url="paint.png")", R"(url='"paint.png"')", R"(url=' "paint.png", "b/paint.png"')",
                                R"(url="&quot;paint.png&quot; &quot;c.png&quot;")"}) {
    for (const bool repeats : {true, false}) {
      const Scene scene = LoadScene(WorldOf(folder.Write(
          "m.x3d",
          "<?xml version='1.0'?><X3D profile='Immersive' version='3.0'><Scene><Shape><Appearance><ImageTexture " + url +
              (repeats ? "" : " repeatS='false'") +
              "/><Material diffuseColor='0.5 0 0'/></Appearance><IndexedFaceSet coordIndex='0 1 2 -1' "
              "texCoordIndex='0 1 2 -1'><Coordinate point='0 0 0 2 0 0 0 2 0'/><TextureCoordinate point='0 0 2 0 0 2'/>"
              "</IndexedFaceSet></Shape></Scene></X3D>")));
      EXPECT_THAT(scene.warnings, IsEmpty()) << url;
      ASSERT_THAT(scene.textures, SizeIs(1)) << url;
      EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).material)).base_color, glm::vec3(1));
      EXPECT_THAT(scene.meshes[0].uvs, testing::Contains(glm::vec2(repeats ? 2.0f : 0.9375f, 1)));
    }
  }
}

TEST(MeshFormats, X3dWarnings) {
  const auto warnings = [](std::string_view text) {
    std::vector<std::string> all;
    EXPECT_EQ(X3dForAssimp(text, all), text);
    return all;
  };
  EXPECT_THAT(warnings("<IndexedFaceSet USE='a'/><Coordinate USE='c'/>"), IsEmpty());
  EXPECT_THAT(warnings("<LOD><Shape/></LOD><Text string='a'/>"), ElementsAre(HasSubstr("all in them: LOD, Text")));
  EXPECT_THAT(warnings("<TextureTransform rotation='1'/>"), ElementsAre(HasSubstr("turns")));
  EXPECT_THAT(warnings("<TextureTransform scale='2 2'/>"), IsEmpty());
  EXPECT_THAT(warnings("<TextureTransform rotation='0' center='0 0' scale='1 1' translation='0.5 0'/>"), IsEmpty());
  EXPECT_THAT(warnings("<Shape DEF='a'/><Shape USE='a'/>"), ElementsAre(HasSubstr("several places (USE)")));
  EXPECT_THAT(warnings("<!-- <IndexedFaceSet coordIndex='7'> <Inline url='b.x3d'/> --><Group/>"), IsEmpty());
  EXPECT_THAT(warnings("<Inline url='b.x3d'/>"), ElementsAre(HasSubstr("(Inline) are not read")));
  EXPECT_THAT(warnings("<MultiTexture><PixelTexture image='0 0 0'/>"), ElementsAre(HasSubstr("than ImageTexture")));
  std::vector<std::string> none;
  EXPECT_EQ(X3dForAssimp("<MetadataString value='\"a\" \"b\"' name='n'/>", none),
            "<MetadataString value='a' name='n'/>");
}

// A file's unit of length, a cone's apex, and shapes without a material beside one that has it.
TEST(MeshFormats, X3dUnitConeAndPlainShapes) {
  const Folder folder;
  const Scene scene = LoadScene(WorldOf(folder.Write(
      "m.x3d",
      "<X3D><head><unit category='length' name='half' conversionFactor='0.5'/></head><Scene><Shape><Appearance>"
      "<Material diffuseColor='1 0 0'/></Appearance><Box/></Shape><Shape><Cone/></Shape></Scene></X3D>")));
  ASSERT_THAT(scene.meshes, SizeIs(2));
  for (const Mesh& mesh : scene.meshes) {
    const bool is_cone = mesh.positions.size() != scene.meshes[0].positions.size();
    const glm::vec3 color = scene.materials.at(static_cast<std::size_t>(mesh.material)).base_color;
    EXPECT_EQ(color, is_cone ? glm::vec3(1) : glm::vec3(1, 0, 0));
    float high = 0, wide = 0;
    for (const glm::vec3& x : mesh.positions) {
      high = std::max(high, x.y);
      if (x.y > 0) wide = std::max(wide, glm::length(glm::vec2(x.x, x.z)));
    }
    EXPECT_FLOAT_EQ(high, 0.5f);
    EXPECT_NEAR(wide, is_cone ? 0 : std::sqrt(0.5f), 1e-6);
  }
  EXPECT_THAT(ProblemTextOf([&] {
                LoadScene(WorldOf(
                    folder.Write("d.x3d", "<X3D><Scene><Shape><Disk2D innerRadius='0.5'/></Shape></Scene></X3D>")));
              }),
              HasSubstr("innerRadius"));
}

// Lists that a fan shares with a set of faces, whose corners get positions of their own; an index without a position.
TEST(MeshFormats, X3dSharedLists) {
  const Folder folder;
  const auto file = [&](const std::string& index) {
    return WorldOf(
        folder.Write("m.x3d", "<X3D><Scene><Shape><IndexedFaceSet DEF='f' coordIndex='" + index +
                                  "'><Coordinate DEF='c' point='0 0 0 1 0 0 1 1 0 0 1 0'/></IndexedFaceSet>"
                                  "</Shape><Shape><IndexedTriangleFanSet index='0 1 2 3 -1'><Coordinate USE='c'/>"
                                  "</IndexedTriangleFanSet></Shape><Transform translation='0 0 1'><Shape>"
                                  "<IndexedFaceSet USE='f'/></Shape></Transform></Scene></X3D>"));
  };
  std::vector<std::size_t> triangles;
  for (const Mesh& mesh : LoadScene(file("0 1 2 3")).meshes) triangles.push_back(mesh.triangles.size());
  EXPECT_THAT(triangles, ElementsAre(2u, 2u, 2u));
  EXPECT_THAT(LoadScene(WorldOf(folder.Write("e.x3d",
                                             "<X3D><Scene><Shape><IndexedFaceSet coordIndex=''><Coordinate "
                                             "point=''/></IndexedFaceSet></Shape><Shape><Box/></Shape></Scene></X3D>")))
                  .meshes,
              SizeIs(1));
  const std::string no_list = "<IndexedTriangleSet index='0 1 2'><CoordinateDouble point='0'/></IndexedTriangleSet>";
  std::vector<std::string> none;
  EXPECT_THROW(X3dForAssimp(no_list, none), std::runtime_error);
  EXPECT_EQ(X3dForAssimp("<IndexedLineSet a=''></IndexedLineSet", none), "");
  EXPECT_EQ(X3dForAssimp("<Cone a=''><Cone a=''>", none), "<Cone a=''><Cone a=''>") << "cut off";
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(file("0 1 4 -1")); }), HasSubstr("not in its list (Coordinate)"));
}

// Nodes of a scene that has lights, cameras or joints alone: nothing stands for them. XML in UTF-16.
TEST(MeshFormats, NoMeshStandsForJointsAndUtf16IsRefused) {
  const Folder folder;
  const auto problem = [&](const std::string& text) {
    return ProblemTextOf([&] { LoadScene(WorldOf(folder.Write("m.dae", text))); });
  };
  EXPECT_THAT(
      problem("<COLLADA version='1.4.1'><library_visual_scenes><visual_scene id='s'><node id='a'><translate>0 1 0"
              "</translate><node id='b'><translate>0 1 0</translate></node></node></visual_scene>"
              "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>"),
      HasSubstr("has no triangles"));
  EXPECT_THAT(problem(std::string("\xff\xfe<\0", 4)), HasSubstr("UTF-16"));
}

TEST(MeshFormats, FilesOfNoMeshAndUnknownContentAreRefusedWithARemedy) {
  const Folder folder;
  const auto problem = [&](const std::string& scene) {
    const std::string text =
        "<?xml version='1.0'?><X3D profile='Immersive' version='3.0'><Scene>" + scene + "</Scene></X3D>";
    return ProblemTextOf([&] { LoadScene(WorldOf(folder.Write("m.x3d", text))); });
  };
  EXPECT_THAT(problem("<Shape><Text string='a'/></Shape>"),
              HasSubstr("no mesh that the importer (assimp) knows: export"));
  EXPECT_THAT(problem("<Foo/>"), testing::AllOf(HasSubstr("\"Foo\""), HasSubstr(".ply have readers of their own")));
}

// OFF: colours of vertices and of faces, which stay on their face, and the forms of the header.
TEST(MeshFormats, Off) {
  const Folder folder;
  const auto load = [&](const std::string& text) { return LoadScene(WorldOf(folder.Write("m.off", text))); };
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const Scene faces = load("OFF # two\n4 2 0\n" + square + "3 0 1 2 255 0 0 255\n3 0 2 3 \n");
  EXPECT_THAT(faces.warnings, IsEmpty());
  std::vector<glm::vec3> colors;
  for (const glm::uvec3& t : faces.meshes.at(0).triangles) {
    const auto& of = faces.meshes[0].colors;
    EXPECT_TRUE(of[t.x] == of[t.y] && of[t.y] == of[t.z]);
    colors.emplace_back(of[t.x]);
  }
  EXPECT_THAT(colors, ElementsAre(glm::vec3(1, 0, 0), glm::vec3(1))) << "white where none is given";
  const Scene vertices = load(
      "STNCOFF4 1 0\n0 0 0 0 0 1 1 0 0 1 0.5 0.25\n1 0 0 0 0 1 1 0 0 1 0 0\n"
      "1 1 0 0 0 1 1 0 0 1 0 0\n0 1 0 0 0 1 1 0 0 1 0 0\n4 0 1 2 3\n");
  EXPECT_THAT(vertices.meshes.at(0).colors, testing::Each(glm::vec3(1, 0, 0)));
  EXPECT_THAT(vertices.meshes[0].normals, testing::Each(glm::vec3(0, 0, 1)));
  EXPECT_THAT(vertices.meshes[0].triangles, SizeIs(2));
  EXPECT_THAT(load("4 1 0\n" + square + "4 0 1 2 3\n").meshes.at(0).colors, IsEmpty()) << "no header";
  const auto problem = [&](const std::string& text) { return ProblemTextOf([&] { load(text); }); };
  EXPECT_THAT(problem("OFF BINARY\n"), HasSubstr("OFF of another kind"));
  EXPECT_THAT(problem("OFF\n4 2 0\n" + square + "3 0 1 2\n"), HasSubstr("ends too early"));
  EXPECT_THAT(problem("OFF\n4 1 0\n" + square + "3 0 1 4\n"), HasSubstr("line 7: a face names a vertex"));
  EXPECT_THAT(problem("OFF\n4 1 0\n" + square + "3 0 1\n"), HasSubstr("line 7: a face lacks vertices"));
}

// A zip archive of files that are stored, or deflated without compression.
std::string ZipOf(const std::vector<std::pair<std::string, std::string>>& files, bool is_deflated) {
  std::string archive, directory;
  for (const auto& [name, content] : files) {
    std::string data;
    if (is_deflated) {
      data = '\1';
      const auto size = static_cast<std::uint16_t>(content.size());
      Append<std::uint16_t>(data, {size, static_cast<std::uint16_t>(~size)});
    }
    data += content;
    std::string common;
    Append<std::uint16_t>(common, {20, 0, static_cast<std::uint16_t>(is_deflated ? 8 : 0), 0, 0, 0, 0});
    Append<std::uint32_t>(common,
                          {static_cast<std::uint32_t>(data.size()), static_cast<std::uint32_t>(content.size())});
    Append<std::uint16_t>(common, {static_cast<std::uint16_t>(name.size()), 0});
    directory += "PK\1\2" + std::string("\x14\0", 2) + common + std::string(10, '\0');
    Append<std::uint32_t>(directory, {static_cast<std::uint32_t>(archive.size())});
    directory += name;
    archive += "PK\3\4" + common + name + data;
  }
  const auto count = static_cast<std::uint16_t>(files.size());
  std::string end = "PK\5\6";
  Append<std::uint16_t>(end, {0, 0, count, count});
  Append<std::uint32_t>(end,
                        {static_cast<std::uint32_t>(directory.size()), static_cast<std::uint32_t>(archive.size())});
  return archive + directory + end + std::string(2, '\0');
}

// Three triangles at heights of 0, 1 and 2 m: a base material, two colours, a picture; placed 3 m to the side by a
// component of another model part.
TEST(MeshFormats, ThreeMf) {
  const auto triangle = [](int i, const std::string& properties) {
    const std::string at = std::to_string(3 * i);
    return "<triangle v1='" + at + "' v2='" + std::to_string(3 * i + 1) + "' v3='" + std::to_string(3 * i + 2) + "' " +
           properties + "/>";
  };
  std::string vertices;
  for (const std::string z : {"0", "1000", "2000"})
    for (const std::string xy : {"x='0' y='0'", "x='1000' y='0'", "x='0' y='1000'"})
      vertices += "<vertex " + xy + " z='" + z + "'/>";
  const std::string part =
      "<model xmlns:m='x'><resources><basematerials id='1'><base name='red' displaycolor='#FF0000'/>"
      "<base name='grey' displaycolor='#808080FF'/></basematerials><m:colorgroup id='2'><m:color color='#0000FF'/>"
      "<m:color color='#00FF00'/></m:colorgroup><m:texture2d id='3' path='/3D/Textures/p.png' contenttype='image/png' "
      "tilestyleu='clamp'/><m:texture2dgroup id='4' texid='3'><m:tex2coord u='0' v='0'/><m:tex2coord u='1' v='0'/>"
      "<m:tex2coord u='0' v='1'/></m:texture2dgroup><!-- <object id='7'> --><object id='7' pid='1' pindex='1'><mesh>"
      "<vertices>" +
      vertices + "</vertices><triangles>" + triangle(0, "") + triangle(1, "pid='2' p1='0' p2='0' p3='1'") +
      triangle(2, "pid='4' p1='0' p2='1' p3='2'") + "</triangles></mesh></object></resources></model>";
  const std::string root =
      "<model unit='millimeter' xmlns:p='y'><resources><object id='1'><components><component objectid='7' "
      "p:path='/3D/part.model' transform='1 0 0 0 1 0 0 0 1 3000 0 0'/></components></object></resources><build>"
      "<item objectid='1'/></build></model>";
  const Folder folder;
  for (const bool is_deflated : {false, true}) {
    const auto file = [&](const std::string& of_root) {
      return ZipOf(
          {{"3D/3dmodel.model", of_root}, {"3D/part.model", part}, {"3D/Textures/p.png", EncodeNoise(".png", 8, 4)}},
          is_deflated);
    };
    const Scene scene = LoadScene(WorldOf(folder.Write("m.3mf", file(root))));
    EXPECT_THAT(scene.warnings, IsEmpty());
    ASSERT_THAT(scene.meshes, SizeIs(3));
    for (const Mesh& mesh : scene.meshes) {
      const Material& material = scene.materials.at(static_cast<std::size_t>(mesh.material));
      const float z = mesh.positions.at(0).z;
      EXPECT_THAT(mesh.positions, testing::Contains(glm::vec3(4, 0, z)));
      if (z == 0) {
        EXPECT_EQ(material.name, "grey");
        EXPECT_NEAR(material.base_color.x, 0.2159f, 1e-4f) << "linear";
      } else if (z == 1) {
        EXPECT_THAT(mesh.colors,
                    testing::UnorderedElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, 1, 0)));
      } else {
        EXPECT_GE(material.texture, 0);
        EXPECT_THAT(mesh.uvs, testing::Contains(glm::vec2(0.0625f, 1))) << "v down; half a texel inside along u";
      }
    }
    const std::string whole = file(root);
    const auto problem = [&](const std::string& bytes) {
      return ProblemTextOf([&] { LoadScene(WorldOf(folder.Write("bad.3mf", bytes))); });
    };
    EXPECT_THAT(problem(whole.substr(0, whole.size() / 2)), HasSubstr("no zip archive"));
    EXPECT_THAT(problem(file("<model><object id='1'><component objectid='1'/></object><item objectid='1'/></model>")),
                HasSubstr("too many or deep"));
  }
}

// Truncation: a file is refused or gives a smaller world (a PLY or OBJ without its end may be valid).
TEST(MeshFormats, TruncatedFilesEndWell) {
  const Folder folder;
  const std::unique_ptr<aiScene> scene(TriangleForExport());
  for (const auto& [format, name] :
       {std::pair{"glb2", "t.glb"}, {"fbxa", "t.fbx"}, {"ply", "t.ply"}, {"obj", "t.obj"}}) {
    Assimp::Exporter exporter;
    const std::string file = (folder.path() / name).string();
    ASSERT_EQ(exporter.Export(scene.get(), format, file), AI_SUCCESS) << exporter.GetErrorString();
    std::ifstream stream(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    int refused = 0;
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 100);
    for (std::size_t length = 0; length < whole.size(); length += step) {
      folder.Write(name, whole.substr(0, length));
      try {
        EXPECT_THAT(LoadScene(WorldOf(file)).meshes, testing::Not(IsEmpty())) << name << " cut off at " << length;
      } catch (const SceneError& error) {
        ++refused;
        EXPECT_THAT(error.problems(), ElementsAre(HasSubstr(name)));
      }
    }
    EXPECT_GT(refused, 25) << name;
  }
}

}  // namespace
}  // namespace sim::test
