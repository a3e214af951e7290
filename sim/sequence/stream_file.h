// File of a sequence, in memory.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

struct StreamFile {
  std::string path;  // relative to the sequence's folder, with '/', without blanks: "rgb/0.033333333.png"
  std::vector<std::uint8_t> bytes;  // all of it
};

inline StreamFile TextFile(std::string path, std::string_view text) {
  return {std::move(path), {text.begin(), text.end()}};
}

}  // namespace sim
