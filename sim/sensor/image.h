// Purpose: what the sensor delivers.
#pragma once

#include <cstdint>
#include <vector>

namespace sim {

struct Image {
  int width = 0, height = 0;
  int channels = 0;                // 1: grey, 3: red, green, blue
  std::vector<std::uint8_t> data;  // width * height * channels, rows from the top
};

}  // namespace sim
