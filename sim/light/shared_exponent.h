// Shared-exponent colours (RGB9_E5): three non-negative numbers in 32 bits, to 0.2 % of the largest. Private to sim.
// Source: the OpenGL extension EXT_texture_shared_exponent: c = mantissa * 2^(exponent - 24).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace sim {

constexpr float kLargestShared = 511.0f / 512.0f * 65536.0f;

// Rounded to the nearest; what is negative (or not a number) becomes 0, what is too large the largest.
inline std::uint32_t PackShared(const glm::vec3& color) {
  float c[3];
  for (int k = 0; k < 3; ++k) c[k] = color[k] > 0 ? std::min(color[k], kLargestShared) : 0.0f;
  const float largest = std::max({c[0], c[1], c[2]});
  int exponent = 0;
  if (largest > 0) std::frexp(largest, &exponent);  // largest < 2^exponent
  int shared = largest > 0 ? std::clamp(exponent + 15, 0, 31) : 0;
  if (std::lround(std::ldexp(largest, 24 - shared)) == 512) ++shared;
  std::uint32_t bits = static_cast<std::uint32_t>(shared) << 27;
  for (int k = 0; k < 3; ++k) bits |= static_cast<std::uint32_t>(std::lround(std::ldexp(c[k], 24 - shared))) << (9 * k);
  return bits;
}

}  // namespace sim
