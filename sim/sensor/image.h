// Digital image of the sensor.
#pragma once

#include <cstdint>
#include <vector>

namespace sim {

struct Image {
  int width = 0, height = 0;
  int channels = 0;                      // 1: grey, or behind a Bayer filter; 3: red, green, blue
  std::vector<std::uint8_t> data;        // width * height * channels, rows from the top; empty above 8 bits
  int bits = 8;                          // of a number: 0 ... 2^bits - 1
  std::vector<std::uint16_t> wide = {};  // instead of data, above 8 bits
};

}  // namespace sim
