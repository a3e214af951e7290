// Images on the sensor plane: linear RGB radiance, and the digital image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

// Of linear RGB with sRGB's primaries.
inline float Luminance(const float* rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

struct RadianceImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  // width * height * 3, rows from the top, red first

  const float* pixel(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

struct Image {
  int width = 0, height = 0;
  int channels = 0;                      // 1: grey, or behind a Bayer filter; 3: red, green, blue
  std::vector<std::uint8_t> data;        // width * height * channels, rows from the top; empty above 8 bits
  int bits = 8;                          // of a number: 0 ... 2^bits - 1
  std::vector<std::uint16_t> wide = {};  // instead of data, above 8 bits
};

}  // namespace sim
