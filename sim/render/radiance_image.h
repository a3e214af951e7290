// Purpose: what the light on the sensor is, before the sensor: linear RGB radiance per pixel.
#pragma once

#include <cstddef>
#include <vector>

namespace sim {

struct RadianceImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  // width * height * 3, rows from the top, red first

  const float* pixel(int x, int y) const {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

}  // namespace sim
