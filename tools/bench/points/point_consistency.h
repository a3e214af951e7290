// Consistency test of any filter on many worlds drawn from its own prior, compared with exact filters of the same
// worlds (docs/point_world.md).
// Source: docs/metrics.md, "Consistency as pass or fail". Needs sim and tools/judge/evaluation only.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "sim/points/point_world.h"
#include "tools/bench/points/point_bench.h"
#include "tools/judge/evaluation/consistency_verdict.h"

namespace vobench {

// A new filter for each world. Of the world it may use a filter's usual input: camera(), scenario(), TruthAt(0).
using MakePointFilter = std::function<PointFilter(const sim::PointWorld& world)>;

struct ConsistencyOptions {
  int runs = 50;               // worlds, each with a seed of its own; 10 or more
  std::uint64_t seed = 1;      // of the first; the others count up from it
  double false_alarm = 0.001;  // of each check; a consistent filter fails the whole in at most verdict.false_alarm()
};

// ANEES, ranks and coverage of every part of the state, and RMSE over the Cramer-Rao bound. The filter's covariance
// after the first frame is taken as that of the start. Throws std::invalid_argument for invalid options, for a world
// that is not drawn from a prior (ProblemOf) and for an estimate that is not finite; what `make` and its filters throw.
evaluation::ConsistencyVerdict TestConsistency(const sim::Scenario& scenario, const MakePointFilter& make,
                                               const ConsistencyOptions& options = {});

// One line for each check that failed: "ANEES mean, pose: 2.01, not <= 1.18". Empty where verdict.consistent(); RMSE
// over the bound is accuracy, not consistency, and is left out.
std::string FailedChecks(const evaluation::ConsistencyVerdict& verdict);

}  // namespace vobench
