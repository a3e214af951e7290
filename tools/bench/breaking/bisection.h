// Bisection of a stress on a fixed grid: which doses are run next, and the breaking point from what has been run.
// Source: docs/bench.md.
#pragma once

#include <optional>
#include <vector>

namespace vobench::breaking {

// Step 0 of the grid is the mildest dose, step `steps` the most severe.
struct StepRuns {
  int step = 0;
  int runs = 0, broken = 0;
};

// The doses of the next round: both ends first; then the middle between the last step at which less than half of the
// runs are broken and the first at which half or more are, of shares made monotone. None when these are neighbours, or
// the stress has no breaking point between its ends.
std::vector<int> NextSteps(const std::vector<StepRuns>& done, int steps);

struct Breaking {
  enum class End { inside, at_the_mildest, not_reached };
  End end = End::not_reached;
  double at = 0, low = 0, high = 1;  // as shares of the way from the mildest (0) to the most severe (1)
};

// The logistic fit with its 90 % interval, never narrower than the spacing of the steps about the breaking point and
// clipped to the ends. Where half of the runs are broken at the mildest, or less than half at the most severe, the
// result is that end, and the interval bounds the breaking point's distance inside. None without runs.
std::optional<Breaking> FindBreaking(const std::vector<StepRuns>& done, int steps);

}  // namespace vobench::breaking
