// Temporary folder of a test, with files in subfolders.
#pragma once

#include <filesystem>
#include <string>

#include "tests/unit/judge/evaluation/temporary_folder.h"

namespace vobench::campaign {

class Folder : public evaluation::TemporaryFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }
  // Creates missing parent folders.
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path() / name).parent_path());
    return TemporaryFolder::Write(name, text);
  }
  std::string Read(const std::string& name) const { return TemporaryFolder::Read(path() / name); }
};

}  // namespace vobench::campaign
