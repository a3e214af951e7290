// Purpose: BRISK descriptors, and the pixel of a region that is nearest to a given one: Algorithm 1, line 3.
// Source:  algorithm, section 7. At the same rotation and scale 99.5 % of the bits are OpenCV's (docs/odometry.md), but
//          neither is estimated from the image: a corner is described as it lies, and looked for as the predicted pose
//          turns and scales it.
// Method:  in a window every pixel has the same pattern, so that a place of the pattern is one box filter with fixed
//          weights along a row of pixels: from the integral image, first down every column, then across. A comparison is
//          one instruction for 8, 16 or 32 pixels. Which instructions the machine has is found out when the program
//          starts; all of them give the same bits.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/instruction_set.h"
#include "vo/features/brisk_pattern.h"

namespace vo {

using Descriptor = std::array<std::uint64_t, 8>;

inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance += std::popcount(a[i] ^ b[i]);
  return distance;
}

// The pattern under a linear map, prepared for sampling at whole pixels.
class BriskSampler {
 public:
  // `map`: from the pattern at scale 1 to the image. Squares stay upright and grow with the root of its determinant, to
  // half a pixel of half-width at the least.
  explicit BriskSampler(const Eigen::Matrix2d& map);

  // Pixels nearer to the edge of the image than this cannot be described.
  int margin() const { return margin_; }

  // A square with fractional borders, relative to the pixel.
  struct Box {
    int left, top, width, height;  // of the first corner; of the inside
    int in_top, in_bottom;         // how much of the first and last row is in the square, in 256ths
    float in_left, in_right;       // of the first and last column
    float per_area;                // 1 / area of it all
  };
  const std::array<Box, kBriskPoints>& boxes() const { return boxes_; }

 private:
  std::array<Box, kBriskPoints> boxes_;
  int margin_ = 0;
};

// Neighbouring pixels of a row, last included.
struct PixelRun {
  int y, first_x, last_x;
};

// An image ready for sampling.
class BriskImage {
 public:
  void Set(const cv::Mat& grey);  // CV_8UC1, copied
  bool Describable(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const;
  // Throws std::invalid_argument where the pixel is not describable.
  Descriptor Describe(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const;
  // The pixel of the region nearest to `descriptor` in Hamming distance, the first where several are; none where no
  // pixel of it can be described.
  struct Found {
    Eigen::Vector2i pixel;
    int distance;
  };
  std::optional<Found> Nearest(const Descriptor& descriptor, const BriskSampler& sampler,
                               std::span<const PixelRun> region) const;
  // The same with the instruction set told, and with what was found at every pixel that can be described, in order.
  std::optional<Found> Nearest(InstructionSet set, const Descriptor& descriptor, const BriskSampler& sampler,
                               std::span<const PixelRun> region, std::vector<Found>* all = nullptr) const;

 private:
  cv::Mat integral_;  // rows are longer than the image's, so that whole vectors can be read at its right edge
  int width_ = 0, height_ = 0;
};

}  // namespace vo
