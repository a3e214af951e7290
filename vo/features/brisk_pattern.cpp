#include "vo/features/brisk_pattern.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace vo {

const std::array<BriskPoint, kBriskPoints>& BriskPattern() {
  static const auto pattern = [] {
    constexpr std::array<double, 5> kRadii = {0, 2.9, 4.9, 7.4, 10.8};
    constexpr std::array<int, 5> kCounts = {1, 10, 14, 15, 20};
    constexpr double kShrink = 0.85, kSmoothing = 1.3;
    std::array<BriskPoint, kBriskPoints> points;
    std::size_t n = 0;
    for (std::size_t ring = 0; ring < kRadii.size(); ++ring) {
      const double radius = kShrink * kRadii[ring];
      const double half_width = kSmoothing * (ring == 0 ? 0.5 : radius * std::sin(std::numbers::pi / kCounts[ring]));
      for (int k = 0; k < kCounts[ring]; ++k) {
        const double angle = 2 * std::numbers::pi * k / kCounts[ring];
        points[n++] = {radius * std::cos(angle), radius * std::sin(angle), half_width};
      }
    }
    return points;
  }();
  return pattern;
}

const std::array<BriskPair, kBriskPairs>& BriskComparisons() {
  static const auto pairs = [] {
    constexpr double kShort = 5.85;  // pairs nearer than this
    const auto& points = BriskPattern();
    std::array<BriskPair, kBriskPairs> all;
    std::size_t n = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if (std::hypot(points[j].x - points[i].x, points[j].y - points[i].y) >= kShort) continue;
        if (n == all.size()) throw std::logic_error("BRISK has 512 short pairs");
        all[n++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)};
      }
    if (n != all.size()) throw std::logic_error("BRISK has 512 short pairs");
    return all;
  }();
  return pairs;
}

}  // namespace vo
