// Recognition of landmarks at the corners of an image by their descriptors alone, independent of the prediction.
// Source:  nearest neighbours with Lowe's ratio test ("Distinctive image features", 2004); docs/algorithm.md, sections
//          7.1 and 7.2.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/brisk.h"
#include "vo/frontend/prepared_frame.h"

namespace vo {

struct RecognisedCorner {
  std::size_t known;  // index of the descriptor
  Eigen::Vector2i pixel;
};

// Corners at which one of `known` is recognised, each corner and each descriptor at most once. `corners_factor`: on
// per_cell, for a landmark's corner to be among those detected.
std::vector<RecognisedCorner> RecogniseCorners(const PreparedFrame& frame, std::span<const Descriptor* const> known,
                                               FeatureParams params, int corners_factor, int border_px);

}  // namespace vo
