// Corners spread over the image by bucketing: in each cell of a grid the FAST threshold falls until enough are found.
// Source:  docs/algorithm.md, section 7; FAST-9 of OpenCV (Rosten & Drummond).
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "vo/base/params.h"

namespace vo {

// New corners, strongest first within a cell, at least min_distance_px from `occupied` and from each other and
// `border_px` from the edge. A cell that holds k of `occupied` gets at most per_cell - k. `grey` is CV_8UC1.
std::vector<Eigen::Vector2i> DetectCorners(const cv::Mat& grey, const std::vector<Eigen::Vector2d>& occupied,
                                           int border_px, const FeatureParams& params);

// Round-robin over the cells of a grid, so that every prefix of the result is spread over the image: indices of
// `pixels`, which come in order of preference; the first of every cell, then the second of every cell, and so on. All
// pixels lie in the image of width x height.
std::vector<std::size_t> BucketRoundRobin(std::span<const Eigen::Vector2d> pixels, int columns, int rows, int width,
                                          int height);

}  // namespace vo
