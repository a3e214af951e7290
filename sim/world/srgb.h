// sRGB transfer function (IEC 61966-2-1), from code to linear light. Both sides in [0, 1].
#pragma once

#include <cmath>

namespace sim {

inline double SrgbToLinear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace sim
