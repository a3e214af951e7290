#include "sim/sequence/journal.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "tools/base/files.h"

namespace sim {
namespace fs = std::filesystem;
namespace {

std::uint32_t Sum(std::span<const std::uint8_t> bytes) { return libdeflate_crc32(0, bytes.data(), bytes.size()); }

bool IsWhole(const fs::path& folder, const JournalFile& file) {
  std::error_code error;
  if (fs::file_size(folder / file.path, error) != file.size || error) return false;
  const std::string bytes = base::ReadFile(folder / file.path).value_or("");
  return bytes.size() == file.size && Sum(base::AsBytes(bytes)) == file.crc32;
}

}  // namespace

std::vector<JournalFile> Summed(std::span<const StreamFile> files) {
  std::vector<JournalFile> summed;
  for (const StreamFile& file : files) summed.push_back({file.path, file.bytes.size(), Sum(file.bytes)});
  return summed;
}

std::string JournalLine(std::int64_t index, std::span<const JournalFile> files) {
  std::string line = std::to_string(index);
  for (const JournalFile& file : files) {
    char sum[16];
    std::snprintf(sum, sizeof sum, "%08x", file.crc32);
    line += " " + file.path + " " + std::to_string(file.size) + " " + sum;
  }
  return line + "\n";
}

Journal ReadJournal(const fs::path& folder) {
  const std::string text = base::ReadFile(folder / kJournalName).value_or("");
  Journal whole;
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
    std::istringstream line(text.substr(start, end - start));
    std::int64_t index = 0;
    std::vector<JournalFile> files;
    line >> index;
    for (JournalFile file; line >> file.path >> std::dec >> file.size >> std::hex >> file.crc32;) files.push_back(file);
    const bool sensible =
        line.eof() && !files.empty() && JournalLine(index, files) == text.substr(start, end + 1 - start);
    if (sensible && std::all_of(files.begin(), files.end(), [&](const auto& file) { return IsWhole(folder, file); })) {
      whole[index] = files;
    }
  }
  return whole;
}

}  // namespace sim
