// Purpose: corners spread over the image: in every cell of a grid the FAST threshold is lowered until enough are found.
// Source:  algorithm, section 7; FAST-9 of OpenCV (Rosten & Drummond).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vo/base/params.h"

namespace vo {

// New corners (whole pixels), strongest first within a cell, at least min_distance_px from `occupied` and from each other and
// `border_px` from the edge. A cell that already holds k of `occupied` gets at most per_cell - k. `grey` is CV_8UC1.
std::vector<Eigen::Vector2i> DetectCorners(const cv::Mat& grey, const std::vector<Eigen::Vector2d>& occupied,
                                           int border_px, const FeatureParams& params);

}  // namespace vo
