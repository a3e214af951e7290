// Checks of poses, velocities, accelerations and inertial readings against each other. Bounds: docs/truth.md.
#pragma once

#include <vector>

#include "tools/judge/verification/files.h"

namespace verification {

// velocity.txt: position and orientation from stamp to stamp; acceleration.txt: velocities; imu0: all three. Checks of
// what is not there have count() 0.
std::vector<Check> CheckMotion(const Sequence& sequence);

}  // namespace verification
