// Landmark table: which anchor each landmark has, the same for all particles, since all associate alike.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vo {

// Keeps the items marked true, in their order.
template <class Item>
void Compact(const std::vector<bool>& keep, std::vector<Item>& items) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < items.size(); ++from)
    if (keep[from]) items[to++] = items[from];
  items.resize(to);
}

class LandmarkTable {
 public:
  int size() const { return static_cast<int>(anchor_of_.size()); }
  int anchor_count() const { return anchor_count_; }
  int anchor_of(int landmark) const { return anchor_of_[landmark]; }
  std::span<const int> anchors() const { return anchor_of_; }  // per landmark

  // New landmarks behind those in the table, with one anchor. Returns its index, which is an unused anchor's or
  // anchor_count() before.
  int Add(int count);
  // Returns the new index of each landmark, -1: dropped. Anchors stay.
  std::vector<int> Keep(const std::vector<bool>& keep);

 private:
  std::vector<int> anchor_of_;
  int anchor_count_ = 0;
};

}  // namespace vo
