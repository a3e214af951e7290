// Purpose: points of the image in an order in which the first of them, however many, are spread over it.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace vo {

// Indices of `pixels`, which come in order of preference: of every cell of a grid of columns x rows the first, then of
// every cell the second, and so on. All lie in the image of width x height.
std::vector<std::size_t> SpreadOver(std::span<const Eigen::Vector2d> pixels, int columns, int rows, int width,
                                    int height);

}  // namespace vo
