// Examples of the docs, compiled and run: the text between two marks in a test's source equals that of the page.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "source_dir.h"

namespace vobench {

inline std::string ReadWhole(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Paths from the project's root.
inline void ExpectInDocs(const std::string& source, const std::string& page) {
  const std::filesystem::path root = VOBENCH_SOURCE_DIR;
  const std::string text = ReadWhole(root / source), mark = "// [example]\n";
  const std::size_t from = text.find(mark) + mark.size();
  const std::string example = text.substr(from, text.find(mark, from) - from);
  ASSERT_GT(example.size(), 500u) << source;
  EXPECT_NE(ReadWhole(root / page).find("```cpp\n" + example + "```\n"), std::string::npos)
      << page << " must have, between ```cpp and ```:\n"
      << example;
}

}  // namespace vobench
