// Run of an external program on a cached sequence; its crash or silence is a result.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/scenario/scenario.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

struct ExternalAnswer {
  campaign::Status status = campaign::Status::ok;  // or crashed, timed_out, no_answer
  std::string reason;                              // of those
  evaluation::Trajectory trajectory;               // of ok
};

// Leaves in `folder` what it printed (log.txt) and the calibration that it was given. Throws std::runtime_error and
// BadInput where it could not be started as its entry says.
ExternalAnswer RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                           const std::string& sequence, const sim::Scenario& scenario, std::uint64_t seed,
                           const std::filesystem::path& folder);

}  // namespace vobench
