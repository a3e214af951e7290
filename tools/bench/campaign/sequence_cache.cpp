#include "tools/bench/campaign/sequence_cache.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "tools/base/files.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

std::string Hex(const XXH128_hash_t& hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

}  // namespace

std::string Digest(std::string_view text) { return Hex(XXH3_128bits(text.data(), text.size())); }

std::string DigestOfFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file)) return "absent";
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  std::vector<char> block(1 << 20);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())), stream.gcount() > 0) {
    XXH3_128bits_update(&state, block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return Hex(XXH3_128bits_digest(&state));
}

fs::path SequenceCache::PathOf(const std::string& key) const { return folder_ / key.substr(0, 2) / key; }

bool SequenceCache::Has(const std::string& key) const { return fs::exists(PathOf(key)); }

FileLock SequenceCache::Take(const std::string& key) const {
  fs::path lock = PathOf(key);
  lock += ".lock";
  fs::create_directories(lock.parent_path());
  return FileLock::Wait(lock, FileLock::Kind::exclusive);
}

fs::path SequenceCache::InputsFile(const std::string& world) const {
  return folder_ / "inputs" / (Digest(world) + ".json");
}

const std::string& SequenceCache::DigestNow(const fs::path& file) {
  const auto [entry, is_new] = digests_.try_emplace(file);
  if (is_new) entry->second = DigestOfFile(file);
  return entry->second;
}

std::optional<std::string> SequenceCache::Inputs(const std::string& world) {
  std::ifstream stream(InputsFile(world), std::ios::binary);
  if (!stream) return std::nullopt;
  const auto files = nlohmann::ordered_json::parse(stream, nullptr, false);
  if (!files.is_object()) return std::nullopt;
  std::string text;
  for (const auto& [file, digest] : files.items()) {
    if (digest != DigestNow(file)) return std::nullopt;
    text += fs::path(file).filename().string() + " " + DigestNow(file) + "\n";
  }
  return text;
}

void SequenceCache::Remember(const std::string& world, const std::set<fs::path>& files) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const fs::path& file : files) json[file.string()] = DigestOfFile(file);
  const fs::path path = InputsFile(world);
  fs::create_directories(path.parent_path());
  base::WriteFile(path, json.dump(1) + "\n", base::Writers::many);
}

std::uint64_t SequenceCache::Bytes() const {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const auto size = entry->symlink_status(gone).type() == fs::file_type::regular ? entry->file_size(gone) : 0;
    if (!gone) bytes += size;
  }
  return bytes;
}

}  // namespace vobench::campaign
