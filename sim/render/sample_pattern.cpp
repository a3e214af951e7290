#include "sim/render/sample_pattern.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <utility>

#include "sim/random/random.h"

namespace sim {

PatternPoint SobolPoint(std::uint32_t i) {
  PatternPoint point;
  std::uint32_t u_direction = 1u << 31, v_direction = 1u << 31;
  for (; i != 0; i >>= 1) {
    if (i & 1u) {
      point.u ^= u_direction;
      point.v ^= v_direction;
    }
    u_direction >>= 1;
    v_direction ^= v_direction >> 1;
  }
  return point;
}

std::vector<glm::dvec2> PointsOnLight(int n) {
  std::vector<glm::dvec2> points;
  std::uint64_t u_sum = 0, v_sum = 0;  // whole numbers: exact
  for (int i = 0; i < n; ++i) {
    const PatternPoint point = SobolPoint(static_cast<std::uint32_t>(i));
    points.emplace_back(ToUnit(point.u), ToUnit(point.v));
    u_sum += point.u, v_sum += point.v;
  }
  const glm::dvec2 mean = glm::dvec2(u_sum, v_sum) / static_cast<double>(n) * 0x1p-32;
  for (glm::dvec2& point : points) point = glm::clamp(point + (0.5 - mean), 0.0, 1.0);
  return points;
}

std::vector<glm::dvec2> DiscPoints(int n) {
  std::vector<glm::dvec2> points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) {
    const double radius = std::sqrt((i + 0.5) / n);
    points.emplace_back(radius * std::cos(golden * i), radius * std::sin(golden * i));
  }
  // Fisher-Yates shuffle with a fixed seed.
  for (int i = n - 1; i > 0; --i) {
    const PixelBits bits = PixelScramble(0x6c656e73u, static_cast<std::uint32_t>(i), 0);  // "lens"
    std::swap(points[static_cast<std::size_t>(i)], points[bits.point.u % (static_cast<std::uint32_t>(i) + 1u)]);
  }
  return points;
}

PixelBits PixelScramble(std::uint64_t key, std::uint32_t x, std::uint32_t y) {
  constexpr auto kStream = static_cast<Stream>(0x70697865u);  // "pixe": a stream of its own for this key
  const Words bits = RandomWords(key, kStream, 0, y, x);
  return {{bits[0], bits[1]}, bits[2], bits[3]};
}

}  // namespace sim
