// Sampling patterns of pixels, area lights and the lens.
// Source: the first two dimensions of Sobol's sequence: any 2^k consecutive aligned points lie one in each elementary
//   interval of area 2^-k (Niederreiter's (0, 2)-sequence); exclusive-oring all points with the same bits keeps that
//   (Kollig and Keller 2002). Bits by pixel: Philox 4x32-10 (Salmon et al. 2011).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace sim {

// A point of the unit square as two 32-bit fractions.
struct PatternPoint {
  std::uint32_t u = 0, v = 0;
};

inline double ToUnit(std::uint32_t fraction) { return (fraction + 0.5) * 0x1p-32; }

// The i-th point of the sequence.
PatternPoint SobolPoint(std::uint32_t i);

// The first n points on an area light, as fractions of its sides, shifted so that their mean is its centre and clamped
// to its edges.
std::vector<glm::dvec2> PointsOnLight(int n);

// The n points of Vogel's spiral (1979) in the unit disc, in an order that is not correlated with SobolPoint.
std::vector<glm::dvec2> DiscPoints(int n);

// Random bits of a pixel, a function of the arguments alone: to be exclusive-ored to its points, a fraction of the time
// of a sample, and of a turn of the disc's points.
struct PixelBits {
  PatternPoint point;
  std::uint32_t time = 0, turn = 0;
};
PixelBits PixelScramble(std::uint64_t key, std::uint32_t x, std::uint32_t y);

}  // namespace sim
