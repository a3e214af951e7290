// Cache of baked light: reuse, detection of damage, and keys that differ for different worlds.
#include "sim/light/cache.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "tests/unit/sim/render/worlds.h"
#include "tests/unit/sim/temporary_folder.h"

namespace sim::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Scene SmallRoom() {
  Scene scene;
  std::vector<std::uint8_t> rgb;
  for (unsigned i = 0; i < 8 * 8 * 3; ++i) rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
  scene.textures.emplace_back("noise", 8, 8, rgb);
  AddMaterial(scene, {0.8f, 0.7f, 0.6f}, glm::vec3(0.0f), 0);
  AddBox(scene, {0, 0, 0}, {4, 3, 4}, 0);
  scene.lights = {PointLight{{2.5, 2.5, 2.0}, {5, 5, 5}, {}}, AmbientLight{}};
  return scene;
}

BakeParams Quick() { return {1.0, 0.5, 4, 4}; }

BakedLight Light(const Scene& scene, const std::vector<fs::path>& folders, std::vector<std::string>& warnings) {
  const RayScene rays(scene);
  return CachedLight(scene, rays, LightMode::baked, Quick(), folders, warnings);
}

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(LightCache, KeepsAndFindsTheSame) {
  const TemporaryFolder folder;
  const Scene scene = SmallRoom();
  std::vector<std::string> warnings;
  const BakedLight first = Light(scene, {folder.path() / "kept"}, warnings);
  const fs::path file = LightFile(folder.path() / "kept", HashOfLight(scene, LightMode::baked, Quick()));
  ASSERT_TRUE(fs::exists(file));
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "a temporary file was left";
  const BakedLight second = Light(scene, {folder.path() / "kept"}, warnings);
  EXPECT_EQ(first.samples, second.samples);
  EXPECT_THAT(warnings, testing::IsEmpty());
  // Control: the light of another valid file in its place is returned, so the file is read.
  BakedLight other = first;
  other.samples[5] ^= 1u;
  WriteLight(file, HashOfLight(scene, LightMode::baked, Quick()), other);
  EXPECT_EQ(Light(scene, {folder.path() / "kept"}, warnings).samples, other.samples);
}

TEST(LightCache, DamageIsSeenAndMended) {
  const TemporaryFolder folder;
  const Scene scene = SmallRoom();
  std::vector<std::string> warnings;
  const BakedLight light = Light(scene, {folder.path()}, warnings);
  const fs::path file = LightFile(folder.path(), HashOfLight(scene, LightMode::baked, Quick()));
  const std::string good = Bytes(file);
  std::vector<std::string> bad{"",
                               good.substr(0, 10),
                               good.substr(0, 72),
                               good.substr(0, good.size() - 1),
                               good + "x",
                               std::string(good.size(), '\0')};
  for (std::size_t at = 0; at < good.size(); at += 41) {
    std::string changed = good;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    bad.push_back(changed);
  }
  for (const std::string& bytes : bad) {
    std::ofstream(file, std::ios::binary) << bytes;
    warnings.clear();
    EXPECT_EQ(Light(scene, {folder.path()}, warnings).samples, light.samples);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], HasSubstr(file.string()));
    EXPECT_THAT(warnings[0], HasSubstr("computed anew"));
    EXPECT_EQ(Bytes(file), good) << "not mended";
  }
}

TEST(LightCache, AnythingThatMattersIsAnotherWorld) {
  const LightHash base = HashOfLight(SmallRoom(), LightMode::baked, Quick());
  EXPECT_EQ(base, HashOfLight(SmallRoom(), LightMode::baked, Quick()));
  EXPECT_NE(base, HashOfLight(SmallRoom(), LightMode::baked_indirect, Quick()));
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene& s) { s.meshes[0].positions[0].x += 1e-6f; },
      [](Scene& s) { std::swap(s.meshes[0].triangles[0].x, s.meshes[0].triangles[0].y); },
      [](Scene& s) { s.meshes[0].uvs[0].x = 0.25f; },
      [](Scene& s) { s.meshes[0].colors.assign(4, glm::vec3(0.5f)); },
      [](Scene& s) { s.materials[0].base_color.y = 0.69f; },
      [](Scene& s) { s.materials[0].emission.y = 0.1f; },
      [](Scene& s) { s.materials[0].texture = -1; },
      [](Scene& s) { s.textures[0] = Texture("noise", 8, 8, std::vector<std::uint8_t>(192, 7)); },
      [](Scene& s) {
        s.lights[0] = PointLight{{2.5, 2.5, 2.0}, {5, 5, 5.001}, {}};
      },
      [](Scene& s) {
        s.lights[0] = PointLight{{2.5, 2.5, 2.0}, {5, 5, 5}, {100, 0.1, 0}};
      },
      [](Scene& s) { s.lights.push_back(SunLight{}); },
      [](Scene& s) { s.background.x = 1; },
      [](Scene& s) { s.sky = Sky{}; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = SmallRoom();
    changes[i](scene);
    EXPECT_NE(base, HashOfLight(scene, LightMode::baked, Quick())) << i;
  }
  for (const BakeParams& params : {BakeParams{0.9, 0.5, 4, 4}, BakeParams{1.0, 0.4, 4, 4}, BakeParams{1.0, 0.5, 8, 4},
                                   BakeParams{1.0, 0.5, 4, 8}}) {
    EXPECT_NE(base, HashOfLight(SmallRoom(), LightMode::baked, params));
  }
  Scene scene = SmallRoom();
  scene.lights[1] = AmbientLight{{9, 9, 9}};  // no part of baked light
  EXPECT_EQ(base, HashOfLight(scene, LightMode::baked, Quick()));
}

TEST(LightCache, GoesWhereItCanBeWritten) {
  const TemporaryFolder folder;
  const Scene scene = SmallRoom();
  std::ofstream(folder.path() / "file") << "in the way";  // a file in place of the folder: for root too
  const fs::path blocked = folder.path() / "file" / "cache", open = folder.path() / "open";
  std::vector<std::string> warnings;
  Light(scene, {blocked, open}, warnings);
  EXPECT_THAT(warnings, testing::IsEmpty());
  EXPECT_TRUE(fs::exists(LightFile(open, HashOfLight(scene, LightMode::baked, Quick()))));
  Light(scene, {blocked}, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("not kept"));
  EXPECT_THAT(warnings[0], HasSubstr(blocked.string()));
}

}  // namespace
}  // namespace sim::test
