#include "vo/map/forgetting.h"

#include <algorithm>
#include <cstddef>

namespace vo {

std::vector<bool> WorthKeeping(std::span<const LandmarkRecord> records, std::size_t wanted,
                               const LandmarkParams& landmark, const ScoreParams& score) {
  std::vector<bool> keep(records.size());
  std::size_t count = wanted;
  std::vector<std::size_t> out_of_view;
  for (std::size_t n = 0; n < records.size(); ++n) {
    const LandmarkRecord& record = records[n];
    const bool exists = record.score >= score.delete_below || record.age < score.grace_frames;
    keep[n] = record.permanent || (exists && record.frames_unsearched < landmark.forget_after);
    if (!keep[n]) continue;
    ++count;
    if (!record.searched) out_of_view.push_back(n);
  }
  const auto room = static_cast<std::size_t>(landmark.max_landmarks);
  if (count <= room) return keep;
  std::stable_sort(out_of_view.begin(), out_of_view.end(), [&](std::size_t a, std::size_t b) {
    return records[a].frames_unsearched > records[b].frames_unsearched;
  });
  for (std::size_t i = 0; i < std::min(count - room, out_of_view.size()); ++i) keep[out_of_view[i]] = false;
  return keep;
}

}  // namespace vo
