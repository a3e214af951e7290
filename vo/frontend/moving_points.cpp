#include "vo/frontend/moving_points.h"

#include <algorithm>

namespace vo {
namespace {

constexpr double kLeastProven = 15, kLeastShare = 0.4;

}  // namespace

void MarkProvisional(std::span<const LandmarkRecord> records, int proving_matches, std::span<Match> matches) {
  const auto proven = [&](const Match& match) { return records[match.landmark].inliers >= proving_matches; };
  const auto count = static_cast<double>(std::ranges::count_if(matches, proven));
  const bool enough = count >= std::max(kLeastProven, kLeastShare * static_cast<double>(matches.size()));
  for (Match& match : matches) match.provisional = enough && !proven(match);
}

}  // namespace vo
