// Ground truth of a run, for the judge alone.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/motion/trajectory.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

struct Truth {
  evaluation::Trajectory poses;
  std::optional<evaluation::Velocities> velocities;
};

// Adds the truth of a frame.
void Append(std::int64_t stamp_ns, const sim::Truth& of_frame, Truth& truth);

}  // namespace vobench
