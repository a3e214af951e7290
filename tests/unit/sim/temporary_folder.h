// Temporary folder of the simulator's tests, and the files in it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tests/temporary_folder.h"

namespace sim {

using vobench_test::TemporaryFolder;

inline std::string ReadWhole(const std::filesystem::path& file) { return TemporaryFolder::Read(file); }

// Every file below a folder with its bytes; folders have none.
inline std::map<std::string, std::string> Tree(const std::filesystem::path& folder) {
  std::map<std::string, std::string> tree;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    tree[entry.path().lexically_relative(folder).string()] = entry.is_regular_file() ? ReadWhole(entry.path()) : "";
  }
  return tree;
}

}  // namespace sim
