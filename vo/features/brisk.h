// BRISK descriptors, and the pixel of a region with the nearest descriptor: Algorithm 1, line 3.
// Source:  docs/algorithm.md, section 7; at equal rotation and scale 99.5 % of the bits are OpenCV's. Neither is
//          estimated from the image: a corner is described upright, and searched for under the predicted warp.
// Method:  all pixels of a window share one pattern, so each pattern point is one box filter with constant weights
//          along a row, evaluated on the integral image: first down each column, then across. A comparison is one
//          instruction for 8, 16 or 32 pixels; the instruction set is chosen at run time, and all give the same bits.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/instruction_set.h"
#include "vo/features/brisk_pattern.h"

namespace vo {

using Descriptor = std::array<std::uint64_t, 8>;

// BRISK's pattern under a linear map, as box filters at whole pixels.
class BriskSampler {
 public:
  // `map`: from the pattern at scale 1 to the image. The boxes stay upright; their half-width is scaled by
  // sqrt(det map), with a minimum of half a pixel.
  explicit BriskSampler(const Eigen::Matrix2d& map);

  // Smallest distance of a describable pixel from the edge of the image.
  int margin() const { return margin_; }

  // Box with fractional borders, relative to the pixel.
  struct Box {
    int left, top, width, height;  // first corner; whole pixels between the borders
    int in_top, in_bottom;         // covered fraction of the first and last row, in 256ths
    float in_left, in_right;       // covered fraction of the first and last column
    float per_area;                // 1 / area
  };
  const std::array<Box, kBriskPoints>& boxes() const { return boxes_; }

 private:
  std::array<Box, kBriskPoints> boxes_;
  int margin_ = 0;
};

// Consecutive pixels of a row, last one included.
struct PixelRun {
  int y, first_x, last_x;
};

// Integral image, from which pixels are described.
class BriskImage {
 public:
  void Set(const cv::Mat& grey);  // CV_8UC1, copied
  // Starts to load what lies within `reach` [px] of a pixel into the cache.
  void Prefetch(const Eigen::Vector2i& pixel, int reach) const;
  bool Describable(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const;
  // Throws std::invalid_argument where the pixel is not describable.
  Descriptor Describe(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const;
  // Pixel of the region nearest to `descriptor` in Hamming distance, the first among equals; none where no pixel of the
  // region is describable.
  struct Found {
    Eigen::Vector2i pixel;
    int distance;
  };
  // `all`: the result at every describable pixel, in order.
  std::optional<Found> Nearest(const Descriptor& descriptor, const BriskSampler& sampler,
                               std::span<const PixelRun> region, InstructionSet set = BestInstructionSet(),
                               std::vector<Found>* all = nullptr) const;

 private:
  cv::Mat integral_;  // rows are longer than the image's, so that whole vectors can be read at its right edge
  int width_ = 0, height_ = 0;
};

}  // namespace vo
