// Gazebo worlds as scenarios: places against poses worked out by hand, in SDF's axes.
#include "tools/bench/import/import.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "sim/scenario/scenario.h"
#include "sim/world/scene.h"
#include "sim/world/texture.h"
#include "tests/temporary_folder.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Folder = vobench_test::TemporaryFolder;

std::string World(const std::string& content) {
  return "<?xml version='1.0'?>\n<sdf version='1.7'><world name='w'>\n" + content + "\n</world></sdf>\n";
}
std::string Model(const std::string& name, const std::string& pose, const std::string& visual) {
  return "<model name='" + name + "'><pose>" + pose + "</pose><link name='link'>" + visual + "</link></model>";
}
std::string Visual(const std::string& geometry, const std::string& more = "") {
  return "<visual name='v'><geometry>" + geometry + "</geometry>" + more + "</visual>";
}

struct Loaded {
  sim::Scenario scenario;
  sim::Scene scene;
  // Corners of the box about a mesh of the scenario, in SDF's axes.
  std::pair<glm::dvec3, glm::dvec3> BoxOf(const std::string& name) const {
    glm::dvec3 low(1e9), high(-1e9);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
      if (scenario.world.meshes[scene.mesh_entries[i]].name != name) continue;
      for (const glm::vec3& p : scene.meshes[i].positions) {
        const glm::dvec3 raw(p.x, -p.z, p.y);
        low = glm::min(low, raw), high = glm::max(high, raw);
      }
    }
    return {low, high};
  }
  void ExpectBox(const std::string& name, const glm::dvec3& low, const glm::dvec3& high) const {
    const auto [got_low, got_high] = BoxOf(name);
    EXPECT_LT(glm::distance(got_low, low) + glm::distance(got_high, high), 1e-5)
        << name << ": (" << got_low.x << ", " << got_low.y << ", " << got_low.z << ") to (" << got_high.x << ", "
        << got_high.y << ", " << got_high.z << ")";
  }
};

Loaded Imported(const Folder& folder, const fs::path& from) {
  Import({.from = from, .output = folder / "made.yaml", .models = {}});
  Loaded loaded{sim::LoadScenario(folder / "made.yaml"), {}};
  loaded.scene = sim::LoadScene(loaded.scenario.world);
  return loaded;
}

std::string ErrorOf(const Folder& folder, const std::string& world) {
  try {
    Imported(folder, folder.Write("world.sdf", world));
  } catch (const BadInput& error) {
    EXPECT_FALSE(fs::exists(folder / "made.yaml"));
    EXPECT_FALSE(fs::exists(folder / "made_shapes"));
    return error.what();
  }
  return "";
}

constexpr char kTriangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

std::string Collada(const std::string& up) {
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>"
         "<up_axis>" +
         up +
         "</up_axis></asset><library_geometries><geometry id='g'><mesh><source id='s'><float_array id='a' count='9'>"
         "0 0 0 1 0 0 0 1 1</float_array><technique_common><accessor source='#a' count='3' stride='3'><param name='X' "
         "type='float'/><param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common>"
         "</source><vertices id='v'><input semantic='POSITION' source='#s'/></vertices><triangles count='1'><input "
         "semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id='w'><node><instance_geometry url='#g'/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

TEST(ImportTest, PosesOfNestedModelsAndFramesAreComposed) {
  const Folder folder;
  const Loaded world = Imported(
      folder,
      folder.Write(
          "world.sdf",
          World("<model name='box'><pose>1 2 0 0 0 1.5707963267948966</pose><link name='l'><pose>0 0 1 0 0 0"
                "</pose><visual name='v'><pose>1 0 0 0 0 0</pose><geometry><box><size>2 1 0.5</size></box>"
                "</geometry></visual></link></model>"
                "<model name='outer'><pose>0 5 0 0 0 0</pose><frame name='f'><pose>0 0 2 0 0 0</pose></frame>"
                "<link name='l'/><model name='k'><pose relative_to='f'>1 0 0 0 0 0</pose><link name='l'>" +
                Visual("<sphere><radius>0.5</radius></sphere>") + "</link></model></model>" +
                Model("pole", "3 0 0 1.5707963267948966 0 0",
                      Visual("<cylinder><radius>0.25</radius><length>4</length></cylinder>")) +
                Model("ground", "0 0 -1 0 0 0", Visual("<plane><normal>0 0 1</normal><size>30 20</size></plane>")) +
                Model("wall", "0 9 0 0 0 0", Visual("<plane><normal>0 -1 0</normal><size>4 6</size></plane>")))));
  world.ExpectBox("box/v", {0.5, 2, 0.75}, {1.5, 4, 1.25});
  world.ExpectBox("outer/v", {0.5, 4.5, 1.5}, {1.5, 5.5, 2.5});
  world.ExpectBox("pole/v", {2.75, -2, -0.25}, {3.25, 2, 0.25});
  world.ExpectBox("ground/v", {-15, -10, -1}, {15, 10, -1});
  world.ExpectBox("wall/v", {-2, 9, -3}, {2, 9, 3});
}

TEST(ImportTest, ModelWithScaleScriptAndTextureIsFound) {
  const Folder folder;
  folder.Write("models/thing/model.config",
               "<?xml version='1.0'?><model><name>thing</name><sdf version='1.6'>model.sdf</sdf></model>");
  folder.Write("models/thing/model.sdf",
               "<?xml version='1.0'?><sdf version='1.6'>" +
                   Model("thing", "0 0 0 0 0 0",
                         Visual("<mesh><uri>model://thing/meshes/t.obj</uri><scale>1 2 3</scale></mesh>",
                                "<material><script><uri>model://thing/materials/scripts</uri><uri>model://thing/"
                                "materials/textures</uri><name>Thing/Red</name></script></material>")) +
                   "</sdf>");
  folder.Write("models/thing/meshes/t.obj", kTriangle);
  folder.Write(
      "models/thing/materials/scripts/a.material",
      "// material Thing/Red { texture no.png }\nmaterial Thing/Blue { technique { pass { texture_unit { texture "
      "no.png } } } }\nmaterial Thing/Red\n{\n technique\n {\n pass { diffuse 1 1 1 1\n texture_unit{\ntexture "
      "red.png\n}}}}\n");
  fs::create_directories(folder / "models/thing/materials/textures");
  cv::imwrite((folder / "models/thing/materials/textures/red.png").string(),
              cv::Mat(4, 4, CV_8UC3, cv::Scalar(0, 0, 255)));
  const Loaded world = Imported(
      folder,
      folder.Write("world.sdf", World("<include><uri>model://thing</uri><name>a_1</name><pose>10 0 0 0 0 0</pose>"
                                      "</include><include><uri>model://thing</uri><name>a_2</name></include>")));
  world.ExpectBox("a_1/v", {10, 0, 0}, {11, 2, 3});
  world.ExpectBox("a_2/v", {0, 0, 0}, {1, 2, 3});
  EXPECT_EQ(world.scenario.world.meshes[0].category, "a");
  const sim::Material& material = world.scene.materials[static_cast<std::size_t>(world.scene.meshes[0].material)];
  ASSERT_GE(material.texture, 0);
  EXPECT_LT(glm::distance(world.scene.textures[static_cast<std::size_t>(material.texture)].Texel(0, 1, 1), {1, 0, 0}),
            1e-6);
  EXPECT_EQ(material.base_color, glm::vec3(1));
}

TEST(ImportTest, ColladaIsTakenInItsOwnAxes) {
  for (const char* up : {"X_UP", "Y_UP", "Z_UP", "\n Z_UP "}) {
    const Folder folder;
    folder.Write("t.dae", Collada(up));
    const Loaded world = Imported(
        folder, folder.Write("world.sdf", World(Model("m", "0 0 0 0 0 0",
                                                      Visual("<mesh><uri>t.dae</uri><scale>1 2 -3</scale></mesh>")))));
    SCOPED_TRACE(up);
    world.ExpectBox("m/v", {0, 0, -3}, {1, 2, 0});
  }
}

TEST(ImportTest, LightsShineAsTheyAreSetUp) {
  const Folder folder;
  const Loaded world = Imported(
      folder,
      folder.Write(
          "world.sdf",
          World("<scene><ambient>1 0 0 1</ambient><background>0 0 1 1</background></scene><light "
                "type='directional' name='sun'><pose>0 0 9 0 0 1.5707963267948966</pose><diffuse>1 1 1 1</diffuse>"
                "<direction>1 0 -1</direction></light><light type='point' name='p'><pose>1 2 3 0 0 0</pose>"
                "<diffuse>1 1 1 1</diffuse><attenuation><range>9</range><constant>0</constant><linear>0</linear>"
                "<quadratic>1</quadratic></attenuation></light>" +
                Model("m", "0 0 0 0 0 0", Visual("<box><size>1 1 1</size></box>")))));
  const std::vector<sim::Light>& lights = world.scenario.world.lights;
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(std::get<sim::AmbientLight>(lights[0]).radiance, glm::dvec3(1, 0, 0));
  const auto& sun = std::get<sim::SunLight>(lights[1]);
  EXPECT_LT(glm::distance(sun.direction, {0, -1, -1}), 1e-9);
  EXPECT_NEAR(sun.irradiance.g, 3.141592654, 1e-8);
  const auto& lamp = std::get<sim::PointLight>(lights[2]);
  EXPECT_LT(glm::distance(lamp.position, {1, 3, -2}), 1e-9);
  EXPECT_NEAR(lamp.intensity.g, 3.141592654, 1e-8);
  EXPECT_EQ(world.scenario.world.background, glm::dvec3(0, 0, 1));
}

TEST(ImportTest, BadInputIsNamedWithFileAndLine) {
  const Folder folder;
  const std::string box = Visual("<box><size>1 1 1</size></box>");
  const std::string missing =
      ErrorOf(folder, World("<include><uri>model://nowhere</uri></include>\n" + Model("m", "a b", box)));
  EXPECT_THAT(missing, HasSubstr("world.sdf:3: Unable to find uri[model://nowhere]; --models names folders"));
  EXPECT_THAT(missing, HasSubstr("world.sdf:4: Error reading element <pose>"));
  EXPECT_THAT(missing, testing::Not(HasSubstr("<world>")));
  EXPECT_THAT(ErrorOf(folder, "<sdf version='1.7'>\n<world name='w'>\n<model nam\n"),
              HasSubstr("world.sdf:3: is not XML"));
  EXPECT_THAT(ErrorOf(folder, "<html/>"), HasSubstr("is neither SDF nor URDF"));
  EXPECT_THAT(ErrorOf(folder, World("\n" + Model("m", "0 0 0 0 0 0", Visual("<mesh><uri>no.obj</uri></mesh>")))),
              HasSubstr("world.sdf:4: no.obj: no such file"));
  EXPECT_THAT(ErrorOf(folder, World(Model("m", "0 0 0 0 0 0", ""))), HasSubstr("has no visuals"));
  EXPECT_THAT(ErrorOf(folder, World("\n" + Model("m", "1,5 0 0 0 0 0", box))),
              HasSubstr("world.sdf:4: <pose>: '1,5 0 0 0 0 0' has commas"));
  folder.Write("bad.obj", "f 1 2 3\n");
  EXPECT_THAT(ErrorOf(folder, World(Model("m", "0 0 0 0 0 0", Visual("<mesh><uri>bad.obj</uri></mesh>")))),
              HasSubstr("bad.obj"));
}

// Links without inertia, meshes beside the file and of the package that it is in.
TEST(ImportTest, UrdfOfAPackage) {
  const Folder folder;
  folder.Write("pkg/meshes/t.obj", kTriangle);
  folder.Write("pkg/urdf/t.obj", kTriangle);
  const auto link = [](const std::string& name, const std::string& mesh) {
    return "<link name='" + name + "'><visual><geometry><mesh filename='" + mesh + "'/></geometry></visual></link>";
  };
  const fs::path file = folder.Write(
      "pkg/urdf/r.urdf", "<robot name='r'>" + link("a", "package://pkg/meshes/t.obj") + link("b", "t.obj") +
                             "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis "
                             "xyz='0 0 1'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint></robot>");
  EXPECT_EQ(Imported(folder, file).scene.meshes.size(), 2u);
}

std::string UrdfBox(const std::string& name, const std::string& more, const std::string& visual = "") {
  return "<link name='" + name + "'>" + more + "<visual><geometry><box size='1 1 1'/></geometry>" + visual +
         "</visual></link>";
}

std::string UrdfOf(const std::string& child, const std::string& more = "") {
  return "<robot name='r'>" + more + UrdfBox("a", "") + child +
         "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>";
}

// No link is lost for its mass or for a shape of another visual; colours are those of the file.
TEST(ImportTest, UrdfLinksAndColours) {
  const Folder folder;
  const std::string massless =
                        "<inertial><mass value='0'/><inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/>"
                        "</inertial>",
                    capsule = "<visual><geometry><capsule radius='1' length='1'/></geometry></visual>",
                    brown = "<material name='brown'><color rgba='0.4 0.2 0.1 1'/></material>";
  for (const std::string& more : {massless, capsule}) {
    const ImportedWorld world =
        ReadSdf(folder.Write("r.urdf", UrdfOf(UrdfBox("b", more, brown))), {}, folder / "shapes");
    ASSERT_EQ(world.world.meshes.size(), 2u) << more;
    EXPECT_EQ(world.warnings.size(), more == capsule ? 1u : 0u);
    const glm::dvec3 color = world.world.meshes[1].color.value();
    EXPECT_NEAR(color.r, sim::SrgbToLinear(0.4), 1e-6);
    EXPECT_NEAR(color.b, sim::SrgbToLinear(0.1), 1e-6);
  }
  const std::string textured = "<material name='t'><texture filename='t.png'/></material>";
  const ImportedWorld grey = ReadSdf(folder.Write("t.urdf", UrdfOf(UrdfBox("b", "", textured))), {}, folder / "shapes");
  EXPECT_NEAR(grey.world.meshes.at(1).color.value().r, sim::SrgbToLinear(0.7), 1e-6);
  EXPECT_THAT(grey.warnings, testing::ElementsAre(HasSubstr("a texture of URDF is left out")));
  const std::string unknown = UrdfOf(UrdfBox("b", "", "<material name='nowhere'/>"));
  EXPECT_THAT(ReadSdf(folder.Write("u.urdf", unknown), {}, folder / "shapes").warnings,
              testing::ElementsAre(HasSubstr("u.urdf:1: 'nowhere': a material without a color is left out")));
}

TEST(ImportTest, UrdfThatCannotBeReadIsRefused) {
  const Folder folder;
  const auto problem = [&](const std::string& text) -> std::string {
    try {
      ReadSdf(folder.Write("r.urdf", text), {}, folder / "shapes");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string turned = "<visual><origin rpy='0 0'/><geometry><box size='1 1 1'/></geometry></visual>";
  EXPECT_THAT(problem(UrdfOf(UrdfBox("b", turned))), HasSubstr("r.urdf: of its 3 visuals only "));
  EXPECT_THAT(problem(UrdfOf(UrdfBox("b", "") + UrdfBox("b", ""))),
              testing::EndsWith("r.urdf: link 'b' is not unique."));
  EXPECT_THAT(problem(UrdfOf("\n<xacro:wheel name='b'/>")), HasSubstr("r.urdf:2: is xacro, not URDF: expand it"));
  EXPECT_THAT(problem(UrdfOf(UrdfBox("${name}", ""))), HasSubstr("is xacro"));
  for (const std::string rgba : {"1 0 0", "255 0 0 1", "red"})
    EXPECT_THAT(problem(UrdfOf(UrdfBox("b", "", "\n<material name='m'><color rgba='" + rgba + "'/></material>"))),
                HasSubstr("r.urdf:2: rgba=\"" + rgba + "\": expected four numbers from 0 to 1"));
}

TEST(ImportTest, ModelConfigNamesTheVersion) {
  const auto model = [](const std::string& size) {
    return "<sdf version='1.5'>" + Model("m", "0 0 0 0 0 0", Visual("<box><size>" + size + "</size></box>")) + "</sdf>";
  };
  for (const char* from : {"thing", "thing/model.config"}) {
    const Folder folder;
    folder.Write("thing/old.sdf", model("1 1 1"));
    folder.Write("thing/new.sdf", model("2 2 2"));
    folder.Write("thing/model.config",
                 "<model><name>t</name><sdf version='1.4'>old.sdf</sdf><sdf version='1.5'>new.sdf</sdf></model>");
    Imported(folder, folder / from).ExpectBox("m/v", {-1, -1, -1}, {1, 1, 1});
  }
}

TEST(ImportTest, MeshesOfASurveyAreMovedToTheOrigin) {
  const Folder folder;
  folder.Write("set/a.obj", "v 500000 4600000 0\nv 500001 4600000 0\nv 500000 4600001 1\nf 1 2 3\n");
  folder.Write("set/b.obj", "v 500002 4600000 0\nv 500003 4600000 0\nv 500002 4600001 1\nf 1 2 3\n");
  const Loaded world = Imported(folder, folder / "set");
  EXPECT_LT(glm::length(world.scene.meshes.at(0).positions[0]), 2);
  EXPECT_EQ(world.scene.meshes.at(1).positions[0] - world.scene.meshes[0].positions[0], glm::vec3(2, 0, 0));
}

TEST(ImportTest, WhatIsLeftOutIsSaid) {
  const Folder folder;
  const std::string box = Visual("<box><size>1 1 1</size></box>", "<material><emissive>0 1 0 1</emissive></material>");
  std::string text = World("<light type='point' name='p'><light_on>false</light_on></light>" +
                           Model("m", "0 0 0 0 0 0", box) + "<state world_name='w'/>");
  text.insert(text.find("</sdf>"), "<world name='second'/>");
  const ImportedWorld world = ReadSdf(folder.Write("world.sdf", text), {}, folder / "shapes");
  EXPECT_EQ(world.lights.size(), 1u) << "the ambient one";
  EXPECT_THAT(world.warnings, testing::UnorderedElementsAre(HasSubstr("worlds after the first"), HasSubstr("<state>"),
                                                            HasSubstr("emission is not rendered")));
}

TEST(ImportTest, WhatThePictureDoesNotShowIsSaid) {
  const Folder folder;
  const std::string clear =
      "<material><diffuse>1 0 0 0.2</diffuse><pbr><metal><normal_map>n.png</normal_map></metal></pbr>"
      "</material><cast_shadows>false</cast_shadows>";
  const std::string scene = "<scene><shadows>false</shadows><fog><type>linear</type></fog></scene>";
  const std::string visual = Visual("<ellipsoid><radii>1 2 3</radii></ellipsoid>", clear);
  const ImportedWorld world =
      ReadSdf(folder.Write("world.sdf", World(scene + Model("m", "0 0 0 0 0 0", visual))), {}, folder / "shapes");
  EXPECT_THAT(world.warnings, testing::UnorderedElementsAre(
                                  HasSubstr("transparency"), HasSubstr("casts a shadow all the same"),
                                  HasSubstr("<shadows> is false"), HasSubstr("<fog>"), HasSubstr("maps of normals")));
  EXPECT_EQ(world.world.meshes.at(0).stretch, glm::dvec3(1, 2, 3));
  for (const char* shape : {"<sphere><radius>-1</radius></sphere>", "<box><size>0 1 1</size></box>"})
    EXPECT_THAT(ErrorOf(folder, World(Model("m", "0 0 0 0 0 0", Visual(shape)))), HasSubstr("its shape has a size of"));
}

TEST(ImportTest, MaterialsOfScripts) {
  const Folder folder;
  const std::vector<fs::path> scripts = {
      folder.Write("a.material",
                   "/* material A { diffuse 1 0 0 } */ material A : B { }\nmaterial C: B { diffuse 0 0 1 }\n"
                   "material B { texture_unit { texture b.png\nscale 2 2 } diffuse 0 1 0\nemissive 1 0 0 }\n")};
  const auto a = FindOgreMaterial("A", scripts), c = FindOgreMaterial("C", scripts),
             glow = FindOgreMaterial("Gazebo/TurquoiseGlow", scripts);
  ASSERT_TRUE(a && c && glow);
  EXPECT_EQ(*a->diffuse, glm::dvec3(0, 1, 0));
  EXPECT_EQ(a->texture, "b.png");
  EXPECT_TRUE(a->is_scaled && a->is_emissive);
  EXPECT_EQ(*c->diffuse, glm::dvec3(0, 0, 1));
  EXPECT_EQ(*glow->diffuse, glm::dvec3(0, 1, 1));
  EXPECT_TRUE(glow->is_emissive);
}

TEST(ImportTest, FilesThatAreNoneAreNamed) {
  const Folder folder;
  const auto problem = [&](const fs::path& from) -> std::string {
    try {
      Imported(folder, from);
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem(folder / "gone.sdf"), HasSubstr("gone.sdf: no such file"));
  EXPECT_THAT(problem(folder.Write("mesh", kTriangle)), HasSubstr("has no extension"));
  ASSERT_EQ(mkfifo((folder / "pipe.sdf").c_str(), 0600), 0);
  EXPECT_THAT(problem(folder / "pipe.sdf"), HasSubstr("pipe.sdf: neither a file nor a folder"));
}

TEST(ImportTest, FolderOfMeshesIsOneWorld) {
  const Folder folder;
  folder.Write("set/a.obj", kTriangle);
  folder.Write("set/b.obj", kTriangle);
  folder.Write("set/readme.txt", "");
  EXPECT_EQ(Imported(folder, folder / "set").scene.meshes.size(), 2u);
  EXPECT_THROW(Imported(folder, folder / "set"), BadInput);  // made.yaml is there
}

}  // namespace
}  // namespace vobench
