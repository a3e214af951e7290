// True pose of the camera at any time, from the truth of a sequence.
// Frames:  T_WC, as docs/conventions.md. Units: metres, nanoseconds.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/bench/points/truth.h"
#include "vo/geometry/pose.h"

namespace vobench {

class TrueMotion {
 public:
  explicit TrueMotion(Truth truth) : truth_(std::move(truth)) {}

  // Between two poses of the truth: cubic Hermite in position and rotation vector where both have a velocity, else
  // linear; beyond the ends at constant velocity. None in gaps of more than 0.25 s, and beyond half of that after an end.
  std::optional<vo::Pose> At(std::int64_t stamp_ns) const;

 private:
  Truth truth_;
};

}  // namespace vobench
