// Linear RGB radiance on the sensor plane, by pixel.
#pragma once

#include <cstddef>
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

}  // namespace sim
