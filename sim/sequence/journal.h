// Journal of an unfinished sequence: the complete frames, a line each in a text file, appended after the files of the
// frame. A frame without a line, or that differs from its line, is rendered again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/sequence/encode.h"

namespace sim {

inline constexpr char kJournalName[] = "frames.journal";

struct JournalFile {
  std::string path;
  std::uint64_t size = 0;
  std::uint32_t crc32 = 0;  // as in zlib, PNG, zip

  friend bool operator==(const JournalFile&, const JournalFile&) = default;
};

// By the frame's index.
using Journal = std::map<std::int64_t, std::vector<JournalFile>>;

std::vector<JournalFile> Summed(std::span<const StreamFile> files);

// "index path size crc32 path size crc32 ...", with the newline.
std::string JournalLine(std::int64_t index, std::span<const JournalFile> files);

// The frames of which every file in `folder` has its size and checksum in the journal there; each file is read whole.
// Truncated or malformed lines are ignored. No journal: no frames.
Journal ReadJournal(const std::filesystem::path& folder);

}  // namespace sim
