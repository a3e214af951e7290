// Flat fields: images of uniform radiance, and the bound on a z-score of them.
#pragma once

#include <glm/vec3.hpp>

#include "sim/sensor/image.h"

namespace sim {

constexpr double kZ = 4.8916;  // |z| beyond it: 1e-6, two-sided

inline RadianceImage Flat(int width, int height, glm::vec3 rgb) {
  RadianceImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), {rgb.x, rgb.y, rgb.z});
  return image;
}

}  // namespace sim
