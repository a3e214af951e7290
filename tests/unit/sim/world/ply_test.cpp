// PLY in its three encodings, with coordinates and colours of vertices, corners and faces.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

class Ply : public testing::Test {
 protected:
  Scene Load(const std::string& text) {
    WorldDescription world;
    world.meshes.push_back({folder_.Write("m.ply", text), {}, {1, 0, 0, 0}, 1, {}, {}});
    return LoadScene(world);
  }
  std::string Problems(const std::string& text) {
    return ProblemTextOf([&] { Load(text); });
  }
  Folder folder_;
};

// The same square, by property types and byte orders.
TEST_F(Ply, AsciiAndBinary) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    std::string text =
        "ply\r\nformat " + format +
        " 1.0\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty float y\nproperty short z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement other 1\nproperty list ushort int a\n"
        "element face 1\nproperty list uchar uint vertex_index\nend_header\n";
    const auto put = [&](auto value) {
      if (format == "ascii") {
        text += std::to_string(value) + " ";
        return;
      }
      std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
      if (format == "binary_big_endian") std::reverse(bytes.begin(), bytes.end());
      text += bytes;
    };
    for (int i = 0; i < 4; ++i) {
      put(i == 1 || i == 2 ? 1.5 : 0.0), put(i > 1 ? 2.5f : 0.0f), put(static_cast<std::int16_t>(-3));
      for (int c = 0; c < 3; ++c) put(static_cast<std::uint8_t>(c == 0 ? 255 : 0));
    }
    put(std::uint16_t{2}), put(7), put(-8);
    put(std::uint8_t{4});
    for (const std::uint32_t i : {0u, 1u, 2u, 3u}) put(i);
    const Scene scene = Load(text);
    ASSERT_THAT(scene.meshes, SizeIs(1)) << format;
    EXPECT_THAT(scene.meshes[0].triangles, SizeIs(2)) << format;
    EXPECT_EQ(scene.meshes[0].positions.at(2), glm::vec3(1.5, 2.5, -3)) << format;
    EXPECT_EQ(scene.meshes[0].colors.at(3), glm::vec3(1, 0, 0)) << format;
    EXPECT_EQ(scene.materials.at(0).base_color, glm::vec3(1)) << format;
    EXPECT_THAT(Problems(text.substr(0, text.size() - 3)), HasSubstr("m.ply")) << format;
  }
}

// Texture coordinates by corner, as of MeshLab: the vertices of an edge are shared, their coordinates are not.
TEST_F(Ply, SeamsOfCorners) {
  folder_.Write("my atlas.png", EncodeColor(".png", 1, 2, 3));
  const Scene scene = Load(
      "ply\nformat ascii 1.0\ncomment TextureFile   my atlas.png \nelement vertex 4\nproperty float x\nproperty float "
      "y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 .5 0 .5 1 0\n3 0 2 3 6 .75 0 1 1 "
      ".75 1 0\n");
  ASSERT_THAT(scene.meshes, SizeIs(1));
  const Mesh& mesh = scene.meshes[0];
  EXPECT_THAT(mesh.positions, SizeIs(6)) << "two of four vertices have two coordinates each";
  const glm::uvec3 second = mesh.triangles.at(1);
  EXPECT_EQ(mesh.positions[second.y], glm::vec3(1, 1, 0));
  EXPECT_EQ(mesh.uvs[second.y], glm::vec2(1, 0));
  EXPECT_EQ(mesh.uvs[mesh.triangles[0].z], glm::vec2(0.5, 0));
  EXPECT_THAT(scene.textures, SizeIs(1));
}

// Three numbers a corner are u, v, w; what is not read of materials and corners' colours is said.
TEST_F(Ply, CornersWithAThirdCoordinate) {
  folder_.Write("t.png", EncodeColor(".png", 1, 2, 3));
  const Scene scene = Load(
      "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property list uchar float color\nproperty int material_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n"
      "3 0 1 2 9 0.25 0 7 0.5 0 7 0.5 1 7 3 1 0 0 0\n");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.uvs.at(mesh.triangles.at(0).y), glm::vec2(0.5, 1));
  EXPECT_EQ(mesh.uvs.at(mesh.triangles.at(0).z), glm::vec2(0.5, 0));
  EXPECT_THAT(scene.warnings, testing::UnorderedElementsAre(HasSubstr("(material_index)"), HasSubstr("(color)")));
}

TEST_F(Ply, TexturesByNumberStripsAndColoursOfFaces) {
  for (const char* name : {"a.png", "b.png"}) folder_.Write(name, EncodeColor(".png", 1, 2, 3));
  const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const Scene two =
      Load("ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n" + vertices +
           "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int "
           "texnumber\nend_header\n" +
           rows + "3 0 1 2 6 0 0 1 0 0 1 0\n3 1 3 2 6 0 0 1 0 0 1 1\n");
  EXPECT_THAT(two.meshes, SizeIs(2));
  EXPECT_THAT(two.textures, SizeIs(2));
  const Scene strips =
      Load("ply\nformat ascii 1.0\n" + vertices +
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + rows + "8 0 1 2 3 -1 1 3 2\n");
  EXPECT_THAT(strips.meshes.at(0).triangles, SizeIs(3));
  for (const glm::uvec3& t : strips.meshes[0].triangles) {
    const auto& p = strips.meshes[0].positions;
    EXPECT_GT(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z, 0) << "all face the same way";
  }
  const Scene faces = Load("ply\nformat ascii 1.0\n" + vertices +
                           "element face 2\nproperty list uchar int vertex_indices\nproperty uchar "
                           "red\nproperty uchar green\nproperty uchar blue\nend_header\n" +
                           rows + "3 0 1 2 255 0 0\n3 1 3 2 0 255 0\n");
  EXPECT_THAT(faces.meshes.at(0).positions, SizeIs(6));
  EXPECT_EQ(faces.meshes[0].colors.at(faces.meshes[0].triangles[1].x), glm::vec3(0, 1, 0));
}

// Faces before vertices, lines that end in CR, colours of 0 ... 255 (or 65535) in wider types.
TEST_F(Ply, AsOtherProgramsWriteIt) {
  for (const auto& [type, white] : std::vector<std::pair<std::string, double>>{
           {"uchar", 255}, {"int", 255}, {"float", 255}, {"ushort", 255}, {"ushort", 65535}, {"float", 1}}) {
    std::string text =
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n";
    for (const char* axis : {"x", "y", "z"}) text += std::string("property float ") + axis + "\n";
    for (const char* channel : {"red", "green", "blue"}) text += "property " + type + " " + channel + "\n";
    text += "end_header\n3 0 1 2\n";
    const std::string color = std::to_string(white) + " 0 0\n";
    text += "0 0 0 " + color + "1 0 0 " + color + "0 1 0 " + color;
    std::ranges::replace(text, '\n', '\r');
    const Scene scene = Load(text);
    EXPECT_EQ(scene.meshes.at(0).colors.at(1), glm::vec3(1, 0, 0)) << type << white;
    EXPECT_EQ(scene.warnings.size(), type == "uchar" || white == 1 ? 0 : 1) << type << white;
  }
}

TEST_F(Ply, CoordinatesByOtherNames) {
  folder_.Write("a.png", EncodeColor(".png", 1, 2, 3));
  for (const auto& [u, v, known] :
       std::vector<std::tuple<std::string, std::string, bool>>{{"S", "T", true},
                                                               {"texcoord_u", "texcoord_v", true},
                                                               {"u0", "v0", true},
                                                               {"uv_0", "uv_1", true},
                                                               {"map_u", "map_v", false}}) {
    std::string text = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n";
    for (const std::string& name : {std::string("x"), std::string("y"), std::string("z"), u, v})
      text += "property float " + name + "\n";
    const Scene scene = Load(text + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                             "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(scene.textures.size(), known ? 1 : 0) << u;
    EXPECT_EQ(base::Join(scene.warnings, "").find("no texture coordinates that are known") == std::string::npos, known);
  }
}

TEST_F(Ply, PicturesByANumberThatIsNotThere) {
  folder_.Write("a.png", EncodeColor(".png", 1, 2, 3));
  const Scene scene = Load(
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_indices\nproperty list uchar float "
      "texcoord\nproperty int texnumber\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 0\n"
      "3 0 1 2 6 0 0 1 0 0 1 5\n3 0 1 2 6 0 0 1 0 0 1 -1\n");
  EXPECT_EQ(std::ranges::count_if(
                scene.meshes,
                [&](const Mesh& m) { return scene.materials[static_cast<std::size_t>(m.material)].texture >= 0; }),
            1);
  EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("2 of its faces name a picture (texnumber)")));
}

TEST_F(Ply, FacesWithoutAListThatIsKnownAndColoursRoundedAboveOne) {
  const auto text = [](const std::string& list, const std::string& red) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float red\nproperty float green\nproperty float blue\nelement face 1\nproperty list uchar int " +
           list + "\nend_header\n0 0 0 " + red + " 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n";
  };
  EXPECT_THAT(Problems(text("indices", "1")), HasSubstr("no list vertex_indices"));
  EXPECT_THAT(Load(text("vertex_index", "1.0000001")).warnings, testing::IsEmpty());
}

TEST_F(Ply, CloudsAndSplatsAreRefusedByName) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n";
  EXPECT_THAT(Problems(head + "property float z\nend_header\n0 0 0\n"), HasSubstr("it is a point cloud"));
  EXPECT_THAT(Problems(head + "property float z\nproperty float f_dc_0\nend_header\n0 0 0 0\n"),
              HasSubstr("it holds Gaussian splats"));
}

TEST_F(Ply, BrokenOnesAreRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(Problems(head + "3 0 1 9\n"), HasSubstr("a face names vertex 10 of 3"));
  EXPECT_THAT(Problems(head + "3 0 1 -1\n"), HasSubstr("a face names vertex"));
  EXPECT_THAT(Problems(head + "300000 0 1 2\n"), HasSubstr("more entries than the file"));
  EXPECT_THAT(Problems(head + "3 0 1 x\n"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(Problems("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n"),
              HasSubstr("'half' is no type"));
}

}  // namespace
}  // namespace sim::test
