// The odometry on worlds drawn from its own prior, in a setting in which it is consistent, and the verdict on it as it is or tampered
// with: for tests that the verdict separates right from wrong on the real filter.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/bench/run/commands.h"
#include "tools/judge/evaluation/consistency_verdict.h"

namespace own_model {

struct Played;  // what is left of the runs
using Runs = std::shared_ptr<const std::vector<Played>>;

// scenes/points.yaml with 12 points, motion noise 0.6 and 0.4, ten frames; marginal mode, 128 particles, lag 3: six of
// nine poses are sampled by the end, few enough that the particles have not collapsed. (With 32 the mixture's highest-density regions are too
// small: of six sets of seeds the smallest p-value of coverage was below 0.00033 in two; with 128 above 0.06 in all of four.) `settings` is
// what is changed about that.
Runs Play(int runs, const vobench::Overrides& settings = {}, std::uint64_t first_seed = 1);

// Instead: no delay, three frames, 128 particles. A window of several frames makes a velocity out of its images and
// hardly needs what was known before; here (37)-(43) are all there is.
vobench::Overrides WithoutDelay();

struct Tampering {
  double covariance = 1;  // the factor that the odometry is made to claim its covariance by, the mixture's too
  int delay = 0;          // frames by which the truth it is held against is late
};
evaluation::ConsistencyVerdict Judge(const Runs& runs, const Tampering& tampering = {});

// All checks but RMSE / bound and the coverage of the mixture's highest-density regions: without delay 128 particles sample
// twelve dimensions too thinly for the latter, in the right filter too.
bool PassesButCoverage(const evaluation::ConsistencyVerdict& verdict);

// Which checks failed, one per line, with value and threshold; all of them where `all` is set.
std::string Failures(const evaluation::ConsistencyVerdict& verdict, bool all = false);

// 0.1 % per check. Seventeen checks: a consistent filter is rejected in at most 1.7 % of tests with fresh seeds; these are
// fixed, so that a test that passes once goes on passing.
inline constexpr double kFalseAlarm = 0.001;
inline constexpr int kRuns = 60;       // of the quick tests
inline constexpr int kWrongRuns = 20;  // of a filter that is wrong by far

}  // namespace own_model
