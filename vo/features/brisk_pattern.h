// Sampling pattern and short-distance pairs of BRISK.
// Source:  Leutenegger, Chli & Siegwart, "BRISK: Binary Robust Invariant Scalable Keypoints", ICCV 2011; numbers and
//          order as in OpenCV.
// Units:   pixels, at scale 1 (a keypoint diameter of 7.2 px in OpenCV's terms).
#pragma once

#include <array>
#include <cstdint>

namespace vo {

inline constexpr int kBriskPoints = 60;
inline constexpr int kBriskPairs = 512;
inline constexpr double kBriskBasicDiameter = 7.2;  // OpenCV's KeyPoint::size of scale 1

// Sampling point on one of five circles: the mean of the image over a square of half-width `half_width`.
struct BriskPoint {
  double x = 0, y = 0, half_width = 0;
};
const std::array<BriskPoint, kBriskPoints>& BriskPattern();

// Bit k of a descriptor: I(first) > I(second).
struct BriskPair {
  std::uint8_t first = 0, second = 0;
};
const std::array<BriskPair, kBriskPairs>& BriskComparisons();

}  // namespace vo
