// Baked irradiance of the triangles of a scene, on a regular triangular lattice per side: light needs neither texture
// coordinates nor an atlas, and cannot leak from one surface to the next.
// Source: Yuksel, Keyser and House 2010, "Mesh colors".
#pragma once

#include <cstddef>
#include <cstdint>
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

// Samples of irradiance / pi (the radiance of a white surface), packed as EXT_texture_shared_exponent
// (sim/light/shared_exponent.h). Each layer has them for all triangles in order, of each the front's lattice and then
// the back's.
struct BakedLight {
  std::vector<TriangleResolution> resolutions;  // by triangle
  std::vector<Flicker> layers;         // the light of lamps with the same flicker is one layer; the first is steady
  std::vector<std::uint32_t> samples;  // layers.size() * (lattices of all triangles)
  bool has_lamps = false;              // direct light is baked too, not only the sky and what bounces
};

}  // namespace sim
