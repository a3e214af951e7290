// Purpose: how the Gauss-Newton iterations of the filter go down, and when they may stop. The decrement of a step, b' A^-1 b, is its squared
//          length in standard deviations of the posterior.
#pragma once

#include <algorithm>
#include <cmath>

namespace vo {

constexpr double kLeft = 1e-2;       // distance from the mode that may be left [standard deviations]
constexpr double kOvershoot = 0.25;  // of the slope before the step: a step past the mode by more is taken back
constexpr double kTolerated = 0.1;   // rise of the objective, which the landmarks' relinearisation may cause

// Whether the mode is near enough after a step of this decrement; `former` is that of the step before it, 0 where there was none. The
// steps to come are taken as a geometric series. Two things that the last two steps alone would hide: far away Gauss-Newton
// converges faster than it does in the end, so the rate counts as no less than a half; and landmarks follow the pose one step
// behind, so a tiny step after a long one says little: the next has been up to a tenth of the long one. (Without the two, up to
// half a standard deviation was left.)
inline bool Settled(double decrement, double former) {
  const double rate = former > 0 ? std::clamp(std::sqrt(decrement / former), 0.5, 1.0) : 0.5;
  const double step = std::sqrt(std::max({decrement, former / 64, 0.0}));
  return step * rate < kLeft * (1 - rate);
}

}  // namespace vo
