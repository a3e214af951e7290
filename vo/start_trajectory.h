// Trajectory of the start: during the start each frame is answered from the images so far; at its end all images of the
// start give its poses anew, as one re-issued trajectory in the scale of the answers. Private to vo.
#pragma once

#include <cstdint>
#include <vector>

#include "vo/base/result.h"
#include "vo/filter/filter.h"
#include "vo/scale_ambiguity.h"

namespace vo {

class StartTrajectory {
 public:
  // A frame and its answer, in order; `scale` as of that frame.
  void Add(std::int64_t stamp_ns, const FilterAnswer& answer, const ScaleAmbiguity& scale);
  // One pose for each frame of the start, where the last frame ended it; else none. Frames that the filter integrated
  // out lie between their neighbours in time.
  const std::vector<StampedPose>& reissued() const { return reissued_; }

 private:
  bool over_ = false;
  std::vector<std::int64_t> stamps_ns_;  // while the start lasts
  std::vector<StampedPose> reissued_;
};

}  // namespace vo
