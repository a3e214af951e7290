// Cache of decoded textures: equal to fresh decoding, also after damage to its files and changes of the images.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "sim/world/scene.h"
#include "tests/unit/sim/world/files.h"

namespace sim::test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::SizeIs;

constexpr char kTriangle[] =
    "mtllib a.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";

// A triangle with a texture of `side` texels a side, and the folder of its cache.
struct World {
  explicit World(int side, const std::string& library = "newmtl paint\nmap_Kd paint.png\n") {
    folder.Write("a.mtl", library);
    picture = folder.Write("paint.png", EncodeNoise(".png", side, side));
    description = WorldOf(folder.Write("a.obj", kTriangle));
    description.cache_folders = {folder / "cache", folder / "elsewhere"};
  }
  Texture Load() const { return LoadScene(description).textures.at(0); }
  std::vector<fs::path> Kept(const char* in = "cache") const {
    if (!fs::exists(folder / in)) return {};
    return {fs::directory_iterator(folder / in), fs::directory_iterator()};
  }
  // Flips a bit.
  static void Damage(const fs::path& file, std::int64_t at) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(at);
    const int byte = stream.get();
    stream.seekp(at);
    stream.put(static_cast<char>(byte ^ 16));
  }

  Folder folder;
  fs::path picture;
  WorldDescription description;
};

bool Same(const Texture& a, const Texture& b) {
  return a.name() == b.name() && a.width() == b.width() && a.height() == b.height() && a.content() == b.content() &&
         std::ranges::equal(a.texels(), b.texels()) && std::ranges::equal(a.alpha(), b.alpha());
}

TEST(TextureCache, WhatIsKeptIsWhatIsDecoded) {
  const World world(600);
  const Texture decoded = world.Load();
  ASSERT_THAT(world.Kept(), SizeIs(1));
  EXPECT_TRUE(Same(world.Load(), decoded));
  EXPECT_THAT(world.Kept(), SizeIs(1));
  // Control: the cache file of another image under this one's name is rejected by its hash.
  const World other(700);
  other.Load();
  fs::copy_file(other.Kept().at(0), world.Kept().at(0), fs::copy_options::overwrite_existing);
  EXPECT_TRUE(Same(world.Load(), decoded));
}

TEST(TextureCache, AlphaAndNumbersAreKeptApart) {
  const World world(600, "newmtl paint\nmap_Kd paint.png\nmap_d paint.png\nnorm paint.png\n");
  const Scene first = LoadScene(world.description), second = LoadScene(world.description);
  ASSERT_THAT(first.textures, SizeIs(2));
  EXPECT_THAT(world.Kept(), SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(Same(first.textures[i], second.textures[i])) << i;
  EXPECT_NE(first.textures[0].content(), first.textures[1].content());
}

TEST(TextureCache, AChangedPictureWithAnUnchangedStampIsNoticed) {
  const World world(600);
  const Texture before = world.Load();
  const auto stamp = fs::last_write_time(world.picture);
  world.folder.Write("paint.png", EncodeNoise(".png", 601, 600));
  fs::last_write_time(world.picture, stamp);
  EXPECT_EQ(world.Load().width(), 601);
  EXPECT_THAT(world.Kept(), SizeIs(2));
}

TEST(TextureCache, ADamagedFileIsMadeAnew) {
  const World world(600);
  const Texture decoded = world.Load();
  const fs::path file = world.Kept().at(0);
  const auto size = static_cast<std::int64_t>(fs::file_size(file));
  for (const std::int64_t at :
       {std::int64_t{3}, std::int64_t{20}, std::int64_t{33}, std::int64_t{41}, size / 2, size - 1}) {
    World::Damage(file, at);
    EXPECT_TRUE(Same(world.Load(), decoded)) << at;
    fs::resize_file(file, static_cast<std::uintmax_t>(at));
    EXPECT_TRUE(Same(world.Load(), decoded)) << "cut off at " << at;
    EXPECT_EQ(static_cast<std::int64_t>(fs::file_size(file)), size) << at;
  }
}

TEST(TextureCache, WhatIsSmallIsNotKeptAndWithoutAFolderTheNextIsTaken) {
  const World small(100);
  small.Load();
  EXPECT_THAT(small.Kept(), IsEmpty());
  const World large(600);
  large.folder.Write("cache", "a file where the folder would be");
  const Texture decoded = large.Load();
  EXPECT_THAT(large.Kept("elsewhere"), SizeIs(1));
  EXPECT_TRUE(Same(large.Load(), decoded));
}

}  // namespace
}  // namespace sim::test
