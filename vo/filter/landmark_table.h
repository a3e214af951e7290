// Landmark table: anchor of each landmark, the same for all particles, since they share the data association.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace vo {

// Keeps the items marked true, in their order.
template <class Item>
void Compact(const std::vector<bool>& keep, std::vector<Item>& items) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < items.size(); ++from) {
    if (!keep[from]) continue;
    if (to != from) items[to] = std::move(items[from]);
    ++to;
  }
  items.resize(to);
}

class LandmarkTable {
 public:
  int size() const { return static_cast<int>(anchor_of_.size()); }
  int anchor_count() const { return anchor_count_; }
  int anchor_of(int landmark) const { return anchor_of_[landmark]; }
  std::span<const int> anchors() const { return anchor_of_; }  // per landmark

  // New landmarks behind those in the table, with one anchor. Returns its index, which is an unused anchor's or
  // anchor_count() before: long runs stay small.
  int Add(int count) {
    std::vector<bool> used(anchor_count_, false);
    for (const int anchor : anchor_of_) used[anchor] = true;
    const int anchor = static_cast<int>(std::find(used.begin(), used.end(), false) - used.begin());
    anchor_count_ = std::max(anchor_count_, anchor + 1);
    anchor_of_.insert(anchor_of_.end(), count, anchor);
    return anchor;
  }
  // Returns the new index of each landmark, -1: dropped. Anchors stay.
  std::vector<int> Keep(const std::vector<bool>& keep) {
    Compact(keep, anchor_of_);
    std::vector<int> index(keep.size(), -1);
    for (int from = 0, to = 0; from < static_cast<int>(keep.size()); ++from)
      if (keep[from]) index[from] = to++;
    return index;
  }

 private:
  std::vector<int> anchor_of_;
  int anchor_count_ = 0;
};

}  // namespace vo
