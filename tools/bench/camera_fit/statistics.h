// Statistics of pictures that tell of their camera: noise against brightness, its correlation, step edges, image motion.
// Source: EMVA 1288 (photon transfer); ISO 12233 (edge spread function); Popescu and Farid 2005 (lattice of a mosaic).
// Units: codes of 0 ... 255 of the green or grey channel; pixels. Pictures: CV_8UC1 or CV_8UC3 (BGR).
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace vobench {

// p-quantile, 0 ... 1, by order; 0 of nothing.
double Quantile(std::vector<double> values, double p);

// Displacement to the next picture of the 49 x 49 px around each of a grid of points, by normalised correlation, within
// 32 px; only where it is clear.
struct Motion {
  cv::Point2f at, by;
};
std::vector<Motion> MeasureMotion(const cv::Mat& picture, const cv::Mat& next);

// Two pictures in a row, and the motion between them.
struct Pair {
  cv::Mat picture, next;
  std::vector<Motion> motions;
  // Of the motion measured nearest to a point, within `reach`.
  const Motion* Nearest(cv::Point2f at, double reach) const;
};

// By range of 20 codes, from 16 x 16 blocks: the flattest twentieth (20 at least) by the gradient of the blurred picture,
// which hardly knows of the noise; or a quarter of those that move by whole pixels (to 1/8), in the difference of both
// pictures, which holds no texture: the smaller of both.
struct NoiseLevel {
  double code = 0;
  double sigma = 0;  // median over blocks, after (1, -2, 1) x (1, -2, 1) / 6, which keeps that of white noise
  std::size_t blocks = 0;
};
struct NoiseStatistics {
  std::vector<NoiseLevel> levels;
  std::array<double, 2>
      correlation{};       // of the difference, of neighbours in a row, in a column, beside a Gaussian of 2 px
  double lattice = 1;      // variance where x + y is even, over that where it is odd, in one picture
  std::size_t blocks = 0;  // behind the last two
};
NoiseStatistics MeasureNoise(std::span<const Pair> pairs);

// A step between two flat sides in a row (or column) of the grey picture.
struct Edge {
  cv::Point2f at;
  bool in_column = false;
  double width = 0;             // 10 ... 90 %, along the row
  double bright = 0, dark = 0;  // halo: mean 1.5, 2, 2.5, 3 px from the middle, beyond the side, over the step
  double low = 0, high = 0;     // codes of its sides
  double slope = 0;             // of the edge: across over along the row
};
std::vector<Edge> FindEdges(const cv::Mat& picture);

cv::Mat Grey(const cv::Mat& picture);  // CV_8UC1

}  // namespace vobench
