#include "vo/features/corner_detector.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <utility>

namespace vo {
namespace {

// Strongest first; ties by position: independent of OpenCV's order.
void SortByResponse(std::vector<cv::KeyPoint>& corners) {
  std::sort(corners.begin(), corners.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.pt.y != b.pt.y ? a.pt.y < b.pt.y : a.pt.x < b.pt.x;
  });
}

bool FarFrom(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& p, double distance) {
  return std::none_of(points.begin(), points.end(),
                      [&](const Eigen::Vector2d& q) { return (p - q).squaredNorm() < distance * distance; });
}

}  // namespace

std::vector<Eigen::Vector2i> DetectCorners(const cv::Mat& grey, const std::vector<Eigen::Vector2d>& occupied,
                                           int border_px, const FeatureParams& params) {
  constexpr int kFastMargin = 3;  // radius of FAST's circle: no corners closer to the edge of its input
  const cv::Rect usable(border_px, border_px, grey.cols - 2 * border_px, grey.rows - 2 * border_px);
  std::vector<Eigen::Vector2i> found;
  if (usable.width <= 0 || usable.height <= 0) return found;
  std::vector<Eigen::Vector2d> taken = occupied;
  std::vector<cv::KeyPoint> corners;
  for (int row = 0; row < params.grid_rows; ++row) {
    for (int column = 0; column < params.grid_columns; ++column) {
      const int x0 = usable.x + usable.width * column / params.grid_columns;
      const int x1 = usable.x + usable.width * (column + 1) / params.grid_columns;
      const int y0 = usable.y + usable.height * row / params.grid_rows;
      const int y1 = usable.y + usable.height * (row + 1) / params.grid_rows;
      int wanted = params.per_cell;
      for (const Eigen::Vector2d& p : occupied)
        if (p.x() >= x0 && p.x() < x1 && p.y() >= y0 && p.y() < y1) --wanted;
      if (wanted <= 0) continue;

      const cv::Rect cell =
          cv::Rect(x0 - kFastMargin, y0 - kFastMargin, x1 - x0 + 2 * kFastMargin, y1 - y0 + 2 * kFastMargin) &
          cv::Rect(0, 0, grey.cols, grey.rows);
      std::vector<Eigen::Vector2d> best;
      // A lower threshold adds weaker corners alone: its steps do not change which are found.
      for (int threshold = params.fast_threshold_start;;
           threshold = std::max(threshold * 4 / 9, params.fast_threshold_min)) {
        cv::FAST(grey(cell), corners, threshold, true);
        SortByResponse(corners);
        best.clear();
        for (const cv::KeyPoint& corner : corners) {
          if (static_cast<int>(best.size()) == wanted) break;
          const Eigen::Vector2d p(corner.pt.x + static_cast<float>(cell.x), corner.pt.y + static_cast<float>(cell.y));
          if (!usable.contains(cv::Point(static_cast<int>(p.x()), static_cast<int>(p.y())))) continue;
          if (FarFrom(taken, p, params.min_distance_px) && FarFrom(best, p, params.min_distance_px)) best.push_back(p);
        }
        if (static_cast<int>(best.size()) == wanted || threshold == params.fast_threshold_min) break;
      }
      for (const Eigen::Vector2d& p : best) {
        taken.push_back(p);
        found.push_back(p.cast<int>());
      }
    }
  }
  return found;
}

std::vector<std::size_t> BucketRoundRobin(std::span<const Eigen::Vector2d> pixels, int columns, int rows, int width,
                                          int height) {
  std::vector<int> in_cell(static_cast<std::size_t>(columns * rows), 0);
  std::vector<std::pair<int, std::size_t>> rounds;  // place within the cell, index
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto column = static_cast<int>(pixels[i].x() * columns / width);
    const auto row = static_cast<int>(pixels[i].y() * rows / height);
    rounds.emplace_back(in_cell[row * columns + column]++, i);
  }
  std::sort(rounds.begin(), rounds.end());
  std::vector<std::size_t> order;
  for (const auto& [round, i] : rounds) order.push_back(i);
  return order;
}

}  // namespace vo
