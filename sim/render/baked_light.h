// Baked irradiance of the triangles of a scene, on a regular triangular lattice per side: light needs neither texture
// coordinates nor an atlas, and cannot leak from one surface to the next.
// Source: Yuksel, Keyser and House 2010, "Mesh colors".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "sim/world/light.h"

namespace sim {

// Resolution R (a power of two): sample (i, j) with i, j >= 0 and i + j <= R lies at u = i / R, v = j / R, where
// X = X_0 + u (X_1 - X_0) + v (X_2 - X_0). Samples are kept row by row (j = 0 first).
constexpr std::size_t LatticeSize(std::size_t resolution) { return (resolution + 1) * (resolution + 2) / 2; }

constexpr std::size_t LatticeIndex(std::size_t resolution, std::size_t i, std::size_t j) {
  return j * (2 * resolution + 3 - j) / 2 + i;
}

// log2 of the resolution on each side of a triangle. The front is where cross(X_1 - X_0, X_2 - X_0) points.
struct TriangleResolution {
  std::uint8_t log2_front = 0, log2_back = 0;
};
constexpr int kMaxLog2Resolution = 11;

// Shared-exponent colours (RGB9_E5): three non-negative numbers in 32 bits, to 0.2 % of the largest.
// Source: the OpenGL extension EXT_texture_shared_exponent: c = mantissa * 2^(exponent - 24).
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

// Samples of irradiance / pi (the radiance of a white surface), of PackShared. Each layer has them
// for all triangles in order, of each the front's lattice and then the back's.
struct BakedLight {
  std::vector<TriangleResolution> resolutions;  // by triangle
  std::vector<Flicker> layers;         // the light of lamps with the same flicker is one layer; the first is steady
  std::vector<std::uint32_t> samples;  // layers.size() * (lattices of all triangles)
  bool has_lamps = false;              // direct light is baked too, not only the sky and what bounces
};

}  // namespace sim
