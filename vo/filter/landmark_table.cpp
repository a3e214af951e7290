#include "vo/filter/landmark_table.h"

#include <algorithm>

namespace vo {

// Anchors are used again, so that long runs stay small.
int LandmarkTable::Add(int count) {
  std::vector<bool> used(anchor_count_, false);
  for (const int anchor : anchor_of_) used[anchor] = true;
  const int anchor = static_cast<int>(std::find(used.begin(), used.end(), false) - used.begin());
  anchor_count_ = std::max(anchor_count_, anchor + 1);
  anchor_of_.insert(anchor_of_.end(), count, anchor);
  return anchor;
}

std::vector<int> LandmarkTable::Keep(const std::vector<bool>& keep) {
  Compact(keep, anchor_of_);
  std::vector<int> index(keep.size(), -1);
  for (int from = 0, to = 0; from < static_cast<int>(keep.size()); ++from)
    if (keep[from]) index[from] = to++;
  return index;
}

}  // namespace vo
