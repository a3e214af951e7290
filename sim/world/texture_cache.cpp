#include "sim/world/texture_cache.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "tools/base/files.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kVersion = 2;  // of the file and of the computation; part of the file's name
constexpr std::size_t kLeastTexels = std::size_t{1} << 18;  // smaller ones are decoded as fast as read

// All of 4 bytes.
struct Head {
  char magic[16];
  std::uint32_t hash[4];
  std::int32_t width, height, content, has_alpha;
};
static_assert(sizeof(Head) == 48);
constexpr char kMagic[16] = "vobench texture";

// 128-bit XXH3 (Collet), not cryptographic; each picture's hash is seeded by the preceding ones.
XXH128_hash_t HashOf(std::span<const ImportedPicture> from, std::uint64_t use) {
  XXH128_hash_t hash = XXH3_128bits_withSeed(&use, sizeof use, kVersion);
  for (const ImportedPicture& picture : from)
    hash = XXH3_128bits_withSeed(picture.bytes.data(), picture.bytes.size(), hash.low64 ^ hash.high64);
  return hash;
}

Head HeadOf(const XXH128_hash_t& hash, const Texture& texture) {
  Head head{
      {}, {}, texture.width(), texture.height(), texture.content() == Texture::Content::numbers, texture.has_alpha()};
  std::memcpy(head.magic, kMagic, sizeof kMagic);
  std::memcpy(head.hash, &hash, sizeof head.hash);
  return head;
}

std::uint64_t Checksum(const Head& head, const Texture& texture) {
  const std::span<const std::byte> texels = std::as_bytes(texture.texels()), alpha = std::as_bytes(texture.alpha());
  return XXH3_64bits_withSeed(texels.data(), texels.size(), XXH3_64bits(&head, sizeof head)) ^
         XXH3_64bits(alpha.data(), alpha.size());
}

std::optional<Texture> Read(const fs::path& file, const std::string& name, const XXH128_hash_t& hash) try {
  std::ifstream in(file, std::ios::binary);
  const auto read = [&](void* to, std::size_t size) {
    if (!in.read(static_cast<char*>(to), static_cast<std::streamsize>(size))) throw std::runtime_error("cut off");
  };
  Head head{};
  read(&head, sizeof head);
  const auto content = head.content != 0 ? Texture::Content::numbers : Texture::Content::color;
  const Texture texture(name, head.width, head.height, content, head.has_alpha != 0, read);
  std::uint64_t checksum = 0;
  read(&checksum, sizeof checksum);
  const Head expected = HeadOf(hash, texture);
  if (std::memcmp(&head, &expected, sizeof head) != 0 || checksum != Checksum(head, texture)) return std::nullopt;
  return texture;
} catch (const std::exception&) {
  return std::nullopt;
}

void Write(const fs::path& file, const XXH128_hash_t& hash, const Texture& texture) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  base::AtomicFile out(file, base::Writers::many);
  const auto write = [&](const void* data, std::size_t size) { out.Append({static_cast<const char*>(data), size}); };
  const Head head = HeadOf(hash, texture);
  const std::uint64_t checksum = Checksum(head, texture);
  write(&head, sizeof head);
  write(texture.texels().data(), texture.texels().size_bytes());
  write(texture.alpha().data(), texture.alpha().size());
  write(&checksum, sizeof checksum);
  out.Commit();
}

}  // namespace

Texture CachedTexture(const std::string& name, std::span<const ImportedPicture> from, std::uint64_t use,
                      const std::vector<fs::path>& folders, const std::function<Texture()>& make) {
  if (folders.empty() || std::ranges::any_of(from, [](const ImportedPicture& p) { return p.height > 0; }))
    return make();
  const XXH128_hash_t hash = HashOf(from, use);
  char file[48];
  std::snprintf(file, sizeof file, "%016llx%016llx.texture", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  for (const fs::path& folder : folders) {
    if (std::optional<Texture> kept = Read(folder / file, name, hash)) return *std::move(kept);
  }
  Texture texture = make();
  if (texture.texels().size() < kLeastTexels) return texture;
  for (const fs::path& folder : folders) {
    try {
      Write(folder / file, hash, texture);
      break;
    } catch (const std::runtime_error&) {  // the next folder; the light's cache reports folders that cannot be written
    }
  }
  return texture;
}

}  // namespace sim
