#include "vo/frontend/spread.h"

#include <algorithm>
#include <utility>

namespace vo {

std::vector<std::size_t> SpreadOver(std::span<const Eigen::Vector2d> pixels, int columns, int rows, int width,
                                    int height) {
  std::vector<int> in_cell(static_cast<std::size_t>(columns * rows), 0);
  std::vector<std::pair<int, std::size_t>> turns;  // its place within the cell, index
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto column = static_cast<int>(pixels[i].x() * columns / width);
    const auto row = static_cast<int>(pixels[i].y() * rows / height);
    turns.emplace_back(in_cell[row * columns + column]++, i);
  }
  std::sort(turns.begin(), turns.end());
  std::vector<std::size_t> order;
  for (const auto& [turn, i] : turns) order.push_back(i);
  return order;
}

}  // namespace vo
