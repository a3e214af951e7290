#include "vo/map/forgetting.h"

#include <algorithm>
#include <cstddef>

namespace vo {

std::vector<bool> WorthKeeping(std::span<const LandmarkRecord> records, const LandmarkParams& landmark,
                               const ScoreParams& score) {
  std::vector<bool> keep(records.size());
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < records.size(); ++n) {
    const LandmarkRecord& record = records[n];
    const bool exists = record.score >= score.delete_below || record.age < score.grace_frames;
    keep[n] = record.permanent || (exists && record.frames_unsearched < landmark.forget_after);
    if (keep[n]) kept.push_back(n);
  }
  const auto room = static_cast<std::size_t>(landmark.max_landmarks);
  if (kept.size() <= room) return keep;
  std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    return records[a].frames_unsearched > records[b].frames_unsearched;
  });
  for (std::size_t i = 0; i < kept.size() - room; ++i) keep[kept[i]] = false;
  return keep;
}

}  // namespace vo
