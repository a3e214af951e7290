// Loading of a world: transforms, materials, texture coordinates, and bad files.
#include <gmock/gmock.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A square of two triangles in the plane z = 0, its upper left corner at (0, 1).
constexpr const char* kSquare =
    "mtllib square.mtl\nusemtl paint\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
constexpr const char* kSquareWithoutUv = "mtllib square.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
constexpr const char* kPlain = "newmtl paint\nKd 0.5 0.25 0.125\nKe 1 2 3\n";

std::vector<std::string> Problems(const WorldDescription& world) {
  return ProblemsOf([&] { LoadScene(world); });
}

std::string Textured(const std::string& texture) { return "newmtl paint\nKd 0.5 0.25 0.125\nmap_Kd " + texture + "\n"; }

TEST(World, ObjWithMaterial) {
  const Folder folder;
  folder.Write("square.mtl", kPlain);
  const Scene scene = LoadScene(WorldOf(folder.Write("square.obj", kSquare)));
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.meshes, SizeIs(1));
  const Mesh& mesh = scene.meshes[0];
  EXPECT_THAT(mesh.positions, SizeIs(4));
  EXPECT_THAT(mesh.triangles, SizeIs(2));
  EXPECT_THAT(mesh.normals, IsEmpty());
  const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
  EXPECT_EQ(material.base_color, glm::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(material.emission, glm::vec3(1, 2, 3));
  EXPECT_EQ(material.texture, -1);
}

// v points up in OBJ and down in the scene: the corner (0, 1) of the mesh has the texture's upper left texel.
TEST(World, TextureIsUpright) {
  const Folder folder;
  folder.Write("square.mtl", Textured("pictures\\paint.png"));
  folder.Write("pictures/paint.png", EncodeNoise(".png", 16, 8));
  const Scene scene = LoadScene(WorldOf(folder.Write("square.obj", kSquare)));
  ASSERT_THAT(scene.textures, SizeIs(1));
  EXPECT_EQ(scene.textures[0].width(), 16);
  const Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(mesh.uvs[i].x, mesh.positions[i].x);
    EXPECT_FLOAT_EQ(mesh.uvs[i].y, 1 - mesh.positions[i].y);
  }
}

TEST(World, PlacedByPositionOrientationAndScale) {
  const Folder folder;
  folder.Write("square.mtl", kPlain);
  WorldDescription world = WorldOf(folder.Write("square.obj", std::string(kSquare) + "vn 0 0 1\nf 1//1 2//1 3//1\n"));
  world.meshes[0].position = {10, 20, 30};
  world.meshes[0].orientation = glm::dquat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // a quarter turn about x: y to z
  world.meshes[0].scale = 2;
  const Scene scene = LoadScene(world);
  bool seen = false;
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::vec3& p : mesh.positions) {
      const bool is_corner =
          glm::all(glm::lessThan(glm::abs(p - glm::vec3(12, 20, 32)), glm::vec3(1e-5f)));  // of (1, 1, 0)
      seen = seen || is_corner;
    }
    for (const glm::vec3& n : mesh.normals) {
      EXPECT_NEAR(n.y, -1, 1e-6);
    }
  }
  EXPECT_TRUE(seen);
}

TEST(World, PlyColoursAreDecoded) {
  const Folder folder;
  const Scene scene = LoadScene(WorldOf(folder.Write(
      "scan.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\n"
      "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 128 0\n1 0 0 255 128 0\n0 1 0 255 128 0\n3 0 1 2\n")));
  ASSERT_THAT(scene.meshes, SizeIs(1));
  ASSERT_THAT(scene.meshes[0].colors, SizeIs(3));
  EXPECT_NEAR(scene.meshes[0].colors[0].x, 1.0, 1e-6);
  EXPECT_NEAR(scene.meshes[0].colors[0].y, SrgbToLinear(128 / 255.0), 1e-6);
  EXPECT_NEAR(scene.meshes[0].colors[0].z, 0.0, 1e-6);
}

TEST(World, OneTextureForManyMeshesIsReadOnce) {
  const Folder folder;
  folder.Write("square.mtl", Textured("paint.png"));
  folder.Write("paint.png", EncodeNoise(".png", 4, 4));
  WorldDescription world = WorldOf(folder.Write("square.obj", kSquare));
  world.meshes.push_back(world.meshes[0]);
  EXPECT_THAT(LoadScene(world).textures, SizeIs(1));
}

// Textures in their order for any number of decoding threads; the renderer's copy has the same texels.
TEST(World, ManyPicturesAreDecodedAtOnce) {
  const Folder folder;
  std::string library, mesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
  for (int i = 0; i < 20; ++i) {
    const std::string name = std::to_string(i);
    folder.Write(name + ".png", EncodeColor(".png", 10 * i, 0, 0));
    library += "newmtl " + name + "\nmap_Kd " + name + ".png\n";
    mesh += "usemtl " + name + "\nf 1/1 2/2 3/3\n";
  }
  folder.Write("m.mtl", library);
  const WorldDescription world = WorldOf(folder.Write("m.obj", mesh));
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    const Scene scene = arena.execute([&] { return LoadScene(world); });
    ASSERT_EQ(scene.textures.size(), 20u);
    for (int i = 0; i < 20; ++i) {
      const Texture& texture = scene.textures[static_cast<std::size_t>(i)];
      EXPECT_NEAR(texture.Texel(0, 0, 0).x, SrgbToLinear(10 * i / 255.0), 2e-3) << i << ", " << threads << " threads";
      EXPECT_EQ(Texture(texture).texels().data(), texture.texels().data());
    }
  }
}

TEST(World, TextureWithoutCoordinatesIsOneWarning) {
  const Folder folder;
  folder.Write("square.mtl", Textured("paint.png"));
  folder.Write("paint.png", EncodeNoise(".png", 4, 4));
  const Scene scene = LoadScene(WorldOf(folder.Write("bare.obj", kSquareWithoutUv)));
  EXPECT_THAT(scene.warnings,
              ElementsAre(AllOf(HasSubstr("bare.obj"), HasSubstr("paint.png"), HasSubstr("texture coordinates"))));
  const Material& material = scene.materials[static_cast<std::size_t>(scene.meshes[0].material)];
  EXPECT_EQ(material.texture, -1);
  EXPECT_EQ(material.base_color, glm::vec3(0.5f, 0.25f, 0.125f));
}

TEST(World, MissingMaterialFileIsAWarning) {
  const Folder folder;
  const Scene scene = LoadScene(WorldOf(folder.Write("square.obj", kSquare)));
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("square.obj"), HasSubstr("square.mtl"))));
}

// ------------------------------------------------------------------------------------------------------ bad files

TEST(BadWorld, MeshThatIsNotThere) {
  const Folder folder;
  EXPECT_THAT(Problems(WorldOf(folder.path() / "none.obj")),
              ElementsAre(AllOf(HasSubstr("none.obj"), HasSubstr("no such file"))));
  EXPECT_THAT(Problems(WorldOf(folder.path())),
              ElementsAre(AllOf(HasSubstr(folder.path().string()), HasSubstr("not a file"))));
}

TEST(BadWorld, CorruptMeshes) {
  const Folder folder;
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"a.glb", "glTF garbage that is no binary"},
                                      {"b.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"meshes\": ["},
                                      {"c.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"},
                                      {"d.fbx", "Kaydara FBX Binary  \x00\x1a and then nothing"},
                                      {"e.obj", "\x7f\x45LF\x01\x02\x03 not a mesh\n"},
                                      {"f.unknown", "whatever"},
                                      {"g.obj", ""}}) {
    EXPECT_THAT(Problems(WorldOf(folder.Write(name, content))), ElementsAre(HasSubstr(name))) << name;
  }
}

TEST(BadWorld, FaceThatNamesAMissingVertex) {
  const Folder folder;
  EXPECT_THAT(Problems(WorldOf(folder.Write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"))),
              ElementsAre(HasSubstr("index.obj")));
}

TEST(BadWorld, NoTriangles) {
  const Folder folder;
  EXPECT_THAT(Problems(WorldOf(folder.Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\n"))),
              ElementsAre(AllOf(HasSubstr("points.obj"), HasSubstr("triangles"))));
}

TEST(BadWorld, CoordinatesThatAreNotFinite) {
  const Folder folder;
  EXPECT_THAT(Problems(WorldOf(folder.Write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"))),
              ElementsAre(AllOf(HasSubstr("nan.obj"), HasSubstr("not finite"), HasSubstr("nan"))));
  EXPECT_THAT(Problems(WorldOf(folder.Write("inf.obj", "v 0 0 0\nv 0 inf 0\nv 0 1 0\nf 1 2 3\n"))),
              ElementsAre(AllOf(HasSubstr("inf.obj"), HasSubstr("not finite"))));
}

TEST(BadWorld, TexturesThatCannotBeUsed) {
  const std::string whole = EncodeNoise(".png", 32, 32), photo = EncodeNoise(".jpg", 32, 32);
  struct Case {
    std::string file, content, complaint;
  };
  for (const Case& c :
       {Case{"gone.png", "", "no such file"}, Case{"cut.png", whole.substr(0, whole.size() / 2), "truncated PNG"},
        Case{"cut.jpg", photo.substr(0, photo.size() - 20), "truncated JPEG"},
        Case{"text.png", "no picture at all", "not a picture"}}) {
    const Folder folder;
    folder.Write("square.mtl", Textured(c.file));
    if (!c.content.empty()) folder.Write(c.file, c.content);
    EXPECT_THAT(Problems(WorldOf(folder.Write("square.obj", kSquare))),
                ElementsAre(AllOf(HasSubstr((folder.path() / c.file).string() + ": "), HasSubstr("square.obj"),
                                  HasSubstr(c.complaint))));
  }
}

TEST(BadWorld, TexturePathsThatLeaveTheFolder) {
  const Folder folder;
  const std::string mesh_folder = "inner";
  folder.Write("secret.png", EncodeNoise(".png", 4, 4));
  for (const std::string& path :
       {std::string("../secret.png"), std::string("x/../../secret.png"), (folder.path() / "secret.png").string(),
        std::string("C:\\secret.png"), std::string("..\\secret.png")}) {
    folder.Write(mesh_folder + "/square.mtl", Textured(path));
    EXPECT_THAT(Problems(WorldOf(folder.Write(mesh_folder + "/square.obj", kSquare))),
                ElementsAre(AllOf(HasSubstr("square.obj"), HasSubstr(path), HasSubstr("inside"))))
        << path;
  }
}

TEST(BadWorld, LightsAndPlacement) {
  const Folder folder;
  folder.Write("square.mtl", kPlain);
  WorldDescription world = WorldOf(folder.Write("square.obj", kSquare));
  const double nan = std::nan("");
  world.lights = {SunLight{{0, 0, 0}, {1, 1, 1}}, PointLight{{nan, 0, 0}, {1, 1, 1}}, AmbientLight{{-1, 0, 0}},
                  RectLight{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 1}}, SunLight{}};
  world.background = {nan, 0, 0};
  world.meshes[0].scale = 0;
  EXPECT_THAT(Problems(world), ElementsAre(HasSubstr("lights[0]"), HasSubstr("lights[1]"), HasSubstr("lights[2]"),
                                           HasSubstr("lights[3]"), HasSubstr("background"), HasSubstr("scale")));
}

TEST(BadWorld, AllProblemsAtOnce) {
  const Folder folder;
  folder.Write("square.mtl", Textured("gone.png") + "newmtl other\nmap_Kd text.png\n");
  folder.Write("text.png", "no picture");
  WorldDescription world = WorldOf(folder.path() / "none.ply");
  world.meshes.push_back({folder.Write("square.obj", std::string(kSquare) + "usemtl other\nf 1/1 2/2 3/3\n"),
                          glm::dvec3(0),
                          {1, 0, 0, 0},
                          1,
                          {},
                          {}});
  world.meshes.push_back(
      {folder.Write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), glm::dvec3(0), {1, 0, 0, 0}, 1, {}, {}});
  world.lights = {SunLight{{0, 0, 0}, {1, 1, 1}}};
  EXPECT_THAT(Problems(world), ElementsAre(HasSubstr("lights[0]"), HasSubstr("none.ply"), HasSubstr("gone.png"),
                                           HasSubstr("nan.obj"), HasSubstr("text.png")));
  try {
    LoadScene(world);
    FAIL() << "nothing was thrown";
  } catch (const std::exception& error) {  // what() has them all, a line each
    const std::string text = error.what();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
  }
}

}  // namespace
}  // namespace sim::test
