// Selection of the landmarks that the map keeps: permanent ones and those that exist, up to the map's capacity.
// Source:  docs/algorithm.md, section 7 (deletion by score); the bound is ours.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/map/landmark_record.h"

namespace vo {

// Kept are the permanent ones, and those that exist and were searched for in the last forget_after frames. Beyond
// max_landmarks, with the `wanted` that are to come, the longest unsearched go, of these the oldest (the first in
// `records`), but none that the last frame searched for.
std::vector<bool> WorthKeeping(std::span<const LandmarkRecord> records, std::size_t wanted,
                               const LandmarkParams& landmark, const ScoreParams& score);

}  // namespace vo
