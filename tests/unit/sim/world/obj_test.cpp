// Dialects of OBJ and MTL files.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A triangle of material a.
constexpr const char* kFace = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";

class Obj : public testing::Test {
 protected:
  Scene Load(const std::string& text, const std::string& name = "m.obj") {
    WorldDescription world;
    world.folders = {folder_.path()};
    world.meshes.push_back({folder_.Write(name, text), position_, {1, 0, 0, 0}, 1, {}, {}});
    return LoadScene(world);
  }
  std::string Problems(const std::string& text) {
    return ProblemTextOf([&] { Load(text); });
  }
  static const Material& MaterialOf(const Scene& scene) {
    return scene.materials.at(static_cast<std::size_t>(scene.meshes.at(0).material));
  }
  // File name of the texture of the first mesh's material.
  static std::string Picture(const Scene& scene) {
    return std::filesystem::path(scene.textures.at(static_cast<std::size_t>(MaterialOf(scene).texture)).name())
        .filename()
        .string();
  }

  Folder folder_;
  glm::dvec3 position_{0};
};

TEST_F(Obj, MarksContinuationsAndNumbers) {
  const Scene scene =
      Load("\xef\xbb\xbfv 0 0 0 # the first\nv +1. 0 \\\n .0\n  v\t0 1e0   -.0  \r\nf 1 2 3\nf -3 -2 -1\n");
  ASSERT_THAT(scene.meshes, SizeIs(1));
  EXPECT_THAT(scene.meshes[0].triangles, SizeIs(2));
  EXPECT_EQ(scene.meshes[0].positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(MaterialOf(scene).base_color, glm::vec3(1)) << "white where no material is named";
}

TEST_F(Obj, TheScenarioReplacesMaterialsByName) {
  folder_.Write("m.mtl", "newmtl a\nKd 0.5 0.5 0.5\nnewmtl b\nKd 0.25 0.25 0.25\n");
  WorldDescription world;
  world.folders = {folder_.path()};
  const std::string text = "mtllib m.mtl\n" + std::string(kFace) + "usemtl b\nf 1/1 2/2 3/3\n";
  world.meshes.push_back({folder_.Write("m.obj", text), position_, {1, 0, 0, 0}, 1, {}, {}});
  world.meshes[0].materials = {{"a", glm::dvec3(0.75, 0.5, 0.25), {}}};
  const Scene scene = LoadScene(world);
  ASSERT_THAT(scene.meshes, SizeIs(2));
  const auto color = [&](int mesh) {
    return scene.materials.at(static_cast<std::size_t>(scene.meshes[static_cast<std::size_t>(mesh)].material))
        .base_color;
  };
  EXPECT_EQ(color(0), glm::vec3(0.75, 0.5, 0.25));
  EXPECT_NE(color(1), color(0));

  world.meshes[0].materials = {{"c", glm::dvec3(1), {}}};
  EXPECT_THAT(ProblemTextOf([&] { LoadScene(world); }),
              HasSubstr("has no material 'c', which the scenario replaces; it has 'a', 'b'"));
}

TEST_F(Obj, ProblemsHaveTheirLines) {
  EXPECT_THAT(Problems("v 0 0 0\nv 1 x 0\nv 0 1\nf 1 2 3\nf 1 2 0\n"),
              AllOf(HasSubstr("line 2: 'x' is not a number"), HasSubstr("line 3: a vertex has three"),
                    HasSubstr("line 5: '0' is not an index")));
  EXPECT_THAT(Problems("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n"), HasSubstr("names texture coordinate 1 of 0"));
  EXPECT_THAT(Problems("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n"), HasSubstr("line 4: -4 names a vertex"));
}

// L-shaped polygon: its triangles cover three quarters of the square for every first corner.
TEST_F(Obj, ConcavePolygons) {
  const std::vector<std::string> corners = {"0 0 0", "1 0 0", "1 0.5 0", "0.5 0.5 0", "0.5 1 0", "0 1 0"};
  for (std::size_t first = 0; first < corners.size(); ++first) {
    for (const bool turned : {false, true}) {
      std::string text;
      for (std::size_t i = 0; i < 6; ++i) text += "v " + corners[(turned ? 12 + first - i : first + i) % 6] + "\n";
      const Scene scene = Load(text + "f 1 2 3 4 5 6\n");
      double area = 0;
      for (const glm::uvec3& t : scene.meshes.at(0).triangles) {
        const auto& p = scene.meshes[0].positions;
        const glm::dvec3 cross = glm::cross(glm::dvec3(p[t.y] - p[t.x]), glm::dvec3(p[t.z] - p[t.x]));
        EXPECT_EQ(cross.z > 0, !turned) << "faces as the polygon does";
        area += 0.5 * std::abs(cross.z);
      }
      EXPECT_NEAR(area, 0.75, 1e-9) << first;
    }
  }
}

// Survey coordinates: the shift by the position is in double, ahead of the rounding to float.
TEST_F(Obj, CoordinatesOfASurvey) {
  position_ = {-691608.25, -5335808.5, -520};
  const Scene scene =
      Load("v 691608.25 5335808.5 520\nv 691609.35 5335808.5 520\nv 691608.25 5335809.7 520\nf 1 2 3\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_NEAR(scene.meshes.at(0).positions[1].x, 1.1, 1e-7);
  EXPECT_NEAR(scene.meshes[0].positions[2].y, 1.2, 1e-7);
}

TEST_F(Obj, VertexColours) {
  const Scene scene = Load("v 0 0 0 0.5 0.5 0.5\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 1 1\nf 1 2 3\n");
  EXPECT_NEAR(scene.meshes.at(0).colors.at(0).x, SrgbToLinear(0.5), 1e-6);
  EXPECT_EQ(MaterialOf(scene).base_color, glm::vec3(1));
  const Scene bytes = Load("v 0 0 0 128 0 0\nv 1 0 0 128 0 0\nv 0 1 0 255 255 255\nf 1 2 3\n");
  EXPECT_NEAR(bytes.meshes.at(0).colors.at(0).x, SrgbToLinear(128 / 255.0), 1e-6);
  EXPECT_THAT(bytes.warnings, ElementsAre(HasSubstr("0 ... 255")));
}

// ZBrush's, in lines of any number of vertices. Of another number than the vertices: none.
TEST_F(Obj, VertexColoursInComments) {
  const auto with = [](const std::string& second) {
    return "v 0 0 1\nv 1 0 1\nv 0 1 1\n#MRGB ffff0000ff00ff00\n#MRGB " + second + "\nf 1 2 3\n";
  };
  const Scene scene = Load(with("ff0000ff"));
  ASSERT_EQ(scene.meshes.at(0).colors.size(), 3U);
  EXPECT_EQ(scene.meshes[0].colors[0], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[0].colors[1], glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.meshes[0].colors[2], glm::vec3(0, 0, 1));
  EXPECT_TRUE(Load(with("ff0000")).meshes.at(0).colors.empty());
}

// A texture replaces vertex colours, which photogrammetry writes beside it; a warning where the colours are not white.
TEST_F(Obj, PictureInPlaceOfVertexColours) {
  folder_.Write("grey.png", EncodeColor(".png", 128, 128, 128));
  folder_.Write("m.mtl", "newmtl a\nmap_Kd grey.png\nnewmtl black\nKd 0 0 0\nmap_Kd grey.png\n");
  const auto wall = [](const std::string& material, const std::string& color) {
    return "mtllib \"m.mtl\"\nusemtl " + material + "\nv 0 0 0" + color + "\nv 1 0 0" + color + "\nv 0 1 0" + color +
           "\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  };
  const Scene scene = Load(wall("a", " 0.5 0.5 0.5"));
  EXPECT_THAT(scene.meshes.at(0).colors, IsEmpty());
  EXPECT_GE(MaterialOf(scene).texture, 0);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("takes the place of vertex colours")));
  EXPECT_THAT(Load(wall("a", " 1 1 1")).warnings, IsEmpty());
  EXPECT_THAT(Load(wall("black", "")).warnings, ElementsAre(HasSubstr("a colour of 0 makes its picture black")));
}

TEST_F(Obj, SaysWhatIsMissing) {
  EXPECT_THAT(Load("usemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").warnings,
              ElementsAre(HasSubstr("names the material 'a', which no library (mtllib) defines")));
}

TEST_F(Obj, PicturesWithoutAColourAreLeftAsTheyAre) {
  folder_.Write("grey.png", EncodeColor(".png", 128, 128, 128));
  folder_.Write("m.mtl", "newmtl a\nmap_Kd grey.png\nnewmtl b\nKd 0.25 0.5 0.75\nmap_Kd grey.png\n");
  EXPECT_EQ(MaterialOf(Load(std::string("mtllib m.mtl\n") + kFace)).base_color, glm::vec3(1));
  const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace + "usemtl b\nf 1/1 2/2 3/3\n");
  ASSERT_THAT(scene.meshes, SizeIs(2));
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(scene.meshes[1].material)).base_color,
            glm::vec3(0.25, 0.5, 0.75));
}

// uv' = scale uv + offset where v points up.
TEST_F(Obj, OptionsOfMaps) {
  folder_.Write("my picture.png", EncodeColor(".png", 1, 2, 3));
  for (const auto& [options, u, v] :
       std::vector<std::tuple<std::string, float, float>>{{"", 1, 1},
                                                          {"-s 2 3 1 ", 2, 3},
                                                          {"-o 0.25 0.5 0 -s 2 1 1 ", 2.25, 1.5},
                                                          {"-s 2 ", 2, 1},
                                                          {"-colorspace sRGB -S 2 3 1 ", 2, 3},
                                                          {"-bm 0.5 -blendu on -o 0.5 ", 1.5, 1}}) {
    folder_.Write("m.mtl", "newmtl a\n\tmap_Kd  " + options + "my picture.png \t\r\n");
    const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace);
    EXPECT_EQ(Picture(scene), "my picture.png") << options;
    EXPECT_NEAR(scene.meshes[0].uvs[1].x, u, 1e-6) << options;
    EXPECT_NEAR(1 - scene.meshes[0].uvs[2].y, v, 1e-6) << options;
  }
}

TEST_F(Obj, OpacityAndEmission) {
  folder_.Write("grey.png", EncodeColor(".png", 128, 128, 128));
  folder_.Write("black.png", EncodeColor(".png", 0, 0, 0));
  folder_.Write("m.mtl", "newmtl a\nmap_Kd grey.png\nmap_d black.png\nmap_Ke grey.png\nTr 1.0\n");
  const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace);
  const Material& material = MaterialOf(scene);
  EXPECT_TRUE(IsCutOut(scene, material));
  EXPECT_EQ(scene.textures.at(static_cast<std::size_t>(material.texture)).Alpha({0.5f, 0.5f}), 0.0f);
  EXPECT_EQ(material.emission, glm::vec3(1));
  EXPECT_GE(material.emission_texture, 0);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("below 0.5 everywhere"))) << "MeshLab's Tr 1.0 is opaque";
  folder_.Write("m.mtl", "newmtl a\nd 0.5\n");
  EXPECT_THAT(Load(std::string("mtllib m.mtl\n") + kFace).warnings,
              ElementsAre(HasSubstr("transparency is not rendered")));
}

TEST_F(Obj, AlphaOfThePictureCutsOut) {
  cv::Mat picture(4, 4, CV_8UC4, cv::Scalar(10, 20, 30, 0));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  folder_.Write("leaf.png", {bytes.begin(), bytes.end()});
  folder_.Write("m.mtl", "newmtl a\nmap_Kd leaf.png\n");
  const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace);
  EXPECT_TRUE(IsCutOut(scene, MaterialOf(scene)));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("below 0.5 everywhere")));
}

// Search order of a library's textures: its own folder, the OBJ's folder, then by file name alone.
TEST_F(Obj, TexturesWhereTheyAre) {
  folder_.Write("models/mats/m.mtl", "newmtl a\nmap_Kd wood.png\n");
  const std::string text = std::string("mtllib mats/m.mtl\n") + kFace;
  const auto loads = [&] { return Load(text, "models/m.obj"); };
  for (const char* place : {"pictures/wood.png", "models/wood.png", "models/mats/wood.png"}) {
    folder_.Write(place, EncodeColor(".png", 1, 2, 3));
    if (std::string(place).starts_with("pictures")) continue;  // in none of the searched folders
    const Scene scene = loads();
    EXPECT_THAT(scene.warnings, IsEmpty()) << place;
    EXPECT_EQ(scene.textures.at(0).name(), (folder_.path() / place).string());
  }
  for (const char* name : {"C:\\\\Users\\\\me\\\\wood.png", "/home/me/wood.png", "nowhere/WOOD.PNG", "Wood.png"}) {
    folder_.Write("models/mats/m.mtl", std::string("newmtl a\nmap_Kd ") + name + "\n");
    const Scene scene = loads();
    EXPECT_EQ(Picture(scene), "wood.png") << name;
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("taken from where one of its name lies"))) << name;
  }
  for (const char* name : {"../pictures/wood.png", "..\\..\\pictures\\wood.png"}) {
    folder_.Write("models/mats/m.mtl", std::string("newmtl a\nmap_Kd ") + name + "\n");
    EXPECT_EQ(loads().textures.at(0).name(), (folder_.path() / "pictures/wood.png").string()) << name;
  }
}

TEST_F(Obj, MissingTexturesAreGreyWhereThatIsAskedFor) {
  folder_.Write("m.mtl", "newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd lost.png\n");
  const std::string text = std::string("mtllib m.mtl\n") + kFace + "usemtl b\nf 1/1 2/2 3/3\n";
  EXPECT_THAT(Problems(text), AllOf(HasSubstr("gone.png: texture of material 'a'"), HasSubstr("no such file")));
  WorldDescription world;
  world.missing_textures = MissingTextures::grey;
  world.meshes.push_back({folder_.Write("m.obj", text), {}, {1, 0, 0, 0}, 1, {}, {}});
  const Scene scene = LoadScene(world);
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("2 ×"), HasSubstr("gone.png"), HasSubstr("is grey"))));
  EXPECT_NEAR(scene.textures.at(0).Texel(0, 0, 0).x, SrgbToLinear(128 / 255.0), 1e-3);
}

TEST_F(Obj, CommentsAndContinuations) {
  folder_.Write("m.mtl", "newmtl a   # the wall\nKd 0.25 0.25 0.25 # dark\nnewmtl Material #25\nKd 1 0 0\n");
  const std::string text = "mtllib m.mtl # one\n# C:\\out\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const Scene scene = Load(text + "usemtl a # note\nf 1 2 \\ \n 3\nusemtl Material #25\nf 1 2 3\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.materials.at(0).base_color, glm::vec3(0.25f));
  EXPECT_EQ(scene.materials.at(1).base_color, glm::vec3(1, 0, 0));
}

TEST_F(Obj, ValuesThatAreNoNumbersAreSaid) {
  folder_.Write("m.mtl", "newmtl a\nKd 0,5 0,5 0,5\nKd spectral red.rfl\nKd xyz 0.2 0.1 0\nKd 0.5\nKd 0.5 0,5 0,5\n");
  const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace);
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("m.mtl: 4 ×"), HasSubstr("line 2: Kd 0,5 0,5 0,5"))));
  EXPECT_EQ(MaterialOf(scene).base_color, glm::vec3(0.5f));
}

TEST_F(Obj, NormalsThatAreNoNumbersAreFlat) {
  const Scene scene = Load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn -1.#IND 0 0\nf 1//1 2//1 3//1\n");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("flat normals are used")));
}

TEST_F(Obj, StrayVerticesDoNotCount) {
  position_ = {-500000, -4600000, 0};
  const Scene scene = Load("v 0 0 0\nv 500000 4600000 0\nv 500001.25 4600000 0\nv 500000 4600001 0\nf 2 3 4\n");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.meshes.at(0).positions[1], glm::vec3(1.25f, 0, 0));
}

TEST_F(Obj, PointsAndLinesAreRefusedByName) {
  EXPECT_THAT(Problems("v 0 0 0\nv 1 0 0\nl 1 2\np 1\n"),
              HasSubstr("points, lines, curves and free-form surfaces are not"));
  EXPECT_THAT(Load(std::string(kFace) + "cstype bspline\nsurf 0 1 0 1 1 2 3\nend\n").warnings,
              Contains(HasSubstr("1 of its surfaces are free-form (surf)")));
}

TEST_F(Obj, FoldersInOtherCapitals) {
  folder_.Write("maps/deep/wood.png", EncodeColor(".png", 1, 2, 3));
  folder_.Write("m.mtl", "newmtl a\nmap_Kd Maps\\Deep\\Wood.PNG\n");
  const Scene scene = Load(std::string("mtllib m.mtl\n") + kFace);
  EXPECT_EQ(Picture(scene), "wood.png");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("taken from where one of its name lies")));
}

TEST_F(Obj, OfAColourAndItsMaskTheBadOneIsNamed) {
  const std::string whole = EncodeNoise(".png", 32, 32);
  folder_.Write("cut.png", whole.substr(0, 100));
  folder_.Write("good.png", whole);
  const auto problems = [&](const std::string& color, const std::string& mask) {
    folder_.Write("m.mtl", "newmtl a\nmap_Kd " + color + "\nmap_d " + mask + "\n");
    return ProblemsOf([&] { Load(std::string("mtllib m.mtl\n") + kFace); });
  };
  EXPECT_THAT(problems("cut.png", "good.png"), ElementsAre(HasSubstr("cut.png: texture of material 'a'")));
  EXPECT_THAT(problems("good.png", "cut.png"), ElementsAre(HasSubstr("cut.png: texture of material 'a'")));
  EXPECT_THAT(problems("gone.png", "good.png"), ElementsAre(HasSubstr("gone.png: texture of material 'a'")));
  EXPECT_THAT(problems("gone.png", "lost.png"), ElementsAre(HasSubstr("gone.png: "), HasSubstr("lost.png: ")));
}

// Brightness masks where all alpha is 255.
TEST_F(Obj, MasksWithOpaqueAlpha) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(4, 4, CV_8UC4, cv::Scalar(0, 0, 0, 255)), bytes);
  folder_.Write("mask.png", {bytes.begin(), bytes.end()});
  folder_.Write("grey.png", EncodeColor(".png", 128, 128, 128));
  folder_.Write("m.mtl", "newmtl a\nmap_Kd grey.png\nmap_d mask.png\n");
  EXPECT_THAT(Load(std::string("mtllib m.mtl\n") + kFace).warnings, ElementsAre(HasSubstr("below 0.5 everywhere")));
}

TEST_F(Obj, BumpMapsAreSaid) {
  folder_.Write("m.mtl", "newmtl a\nmap_Bump -bm 0.5 x.png\nnewmtl b\nbump x.png\n");
  const Scene scene = Load("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n");
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("2 ×"), HasSubstr("bump maps (heights) are not rendered"))));
}

// Warnings of one kind: a single line with their number.
TEST_F(Obj, WarningsAreSummed) {
  std::string library, text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* name : {"a", "b", "c"}) {
    library += std::string("newmtl ") + name + "\nd 0.5\n";
    text += std::string("usemtl ") + name + "\nf 1 2 3\n";
  }
  folder_.Write("m.mtl", library);
  EXPECT_THAT(Load(text).warnings, ElementsAre(AllOf(HasSubstr("3 × transparency"), HasSubstr("material 'a'"))));
}

}  // namespace
}  // namespace sim::test
