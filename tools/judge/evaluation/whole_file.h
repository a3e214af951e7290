// Purpose: writing files whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace evaluation {

// A file that is there whole or not at all: written under a temporary name beside it, as it comes, and renamed when all
// of it is on disk. What throws is std::runtime_error, naming the file and the reason (disk full, no such folder);
// then, and where nothing is committed, the old file, if any, is untouched and no temporary one remains.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void Append(std::string_view text);
  void Commit();

 private:
  void Flush();
  void Write(std::string_view bytes);
  [[noreturn]] void Fail(const std::error_code& why) const;

  std::filesystem::path file_, temporary_;
  int descriptor_ = -1;
  std::string buffer_;
};

// The same at once.
void WriteWhole(const std::filesystem::path& file, const std::string& content);

}  // namespace evaluation
