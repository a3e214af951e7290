// Cache of rendered sequences, named by their content and shared by all systems and campaigns.
//
//   DIR/ab/abcd...        a sequence, complete: renamed when all of it is written
//   DIR/ab/abcd....lock   held by the process that renders it
//   DIR/inputs/...json    files that a world is read from, and their digests at the last reading
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/bench/campaign/file_lock.h"

namespace vobench::campaign {

// Digests of a content, not cryptographic (XXH3 of 128 bits, Collet), as 32 hexadecimal digits; of a file "absent"
// where it cannot be opened.
std::string Digest(std::string_view text);
std::string DigestOfFile(const std::filesystem::path& file);

class SequenceCache {
 public:
  explicit SequenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
  const std::filesystem::path& folder() const { return folder_; }

  std::filesystem::path PathOf(const std::string& key) const;
  bool Has(const std::string& key) const;
  // Waits until no other process makes this sequence, and locks it. Throws std::runtime_error.
  FileLock Take(const std::string& key) const;

  // The files that a world is read from, with their digests, as one text; none where it was never read, or one of them
  // has changed since: the files it names may then have changed, too. `world` names it.
  std::optional<std::string> Inputs(const std::string& world);
  // Stores the files found by reading the world. Throws std::runtime_error.
  void Remember(const std::string& world, const std::set<std::filesystem::path>& files);

  // Digest of a file, which is read once.
  const std::string& DigestNow(const std::filesystem::path& file);

  // Total size of the cache's files.
  std::uint64_t Bytes() const;

 private:
  std::filesystem::path InputsFile(const std::string& world) const;

  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::string> digests_;
};

}  // namespace vobench::campaign
