// Points that may move on their own. A landmark counts as static once it has agreed with the robust pose often enough;
// until then its matches are provisional: the pose is estimated without them, and they have to agree with it. Moving
// points are thus rejected before they affect the pose, however many landmarks begin on them.
// Source:  docs/algorithm.md, section 7.3.
#pragma once

#include <span>

#include "vo/map/landmark.h"
#include "vo/map/landmark_record.h"

namespace vo {

// Marks the matches of landmarks with fewer than `proving_matches` inliers so far as provisional, where enough others
// are left for the pose: 15 matches, and two fifths of all. None elsewhere. `records`: of all landmarks, by index.
void MarkProvisional(std::span<const LandmarkRecord> records, int proving_matches, std::span<Match> matches);

}  // namespace vo
