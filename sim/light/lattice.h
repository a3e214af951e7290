// Purpose: where on a triangle its light is kept: samples on a regular triangular lattice, so that light needs neither
//          texture coordinates nor an atlas, and cannot leak from one surface to the next.
// Source:  Yuksel, Keyser and House 2010, "Mesh colors".
#pragma once

#include <cstddef>
#include <cstdint>

namespace sim {

// Resolution R (a power of two): sample (i, j) with i, j >= 0 and i + j <= R lies at u = i / R, v = j / R, where
// X = X_0 + u (X_1 - X_0) + v (X_2 - X_0). Samples are kept row by row (j = 0 first).
constexpr std::size_t LatticeSize(std::size_t resolution) { return (resolution + 1) * (resolution + 2) / 2; }

constexpr std::size_t LatticeIndex(std::size_t resolution, std::size_t i, std::size_t j) {
  return j * (2 * resolution + 3 - j) / 2 + i;
}

// How finely each side of a triangle is sampled: log2 of the resolution. The front is where cross(X_1 - X_0, X_2 - X_0)
// points.
struct TriangleResolution {
  std::uint8_t log2_front = 0, log2_back = 0;
};
constexpr int kMaxLog2Resolution = 11;  // whatever spacing was asked for

}  // namespace sim
