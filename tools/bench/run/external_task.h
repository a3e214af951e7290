// Run of an external program on a cached sequence; its crash or silence is a result.
#pragma once

#include <filesystem>
#include <string>

#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/run/served_sequence.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

struct ExternalAnswer {
  evaluation::Trajectory trajectory;
  std::vector<std::int64_t> frame_stamps_ns;
  double seconds = 0;  // that the program took
};

// The answer, with record.seed; where there is none, status (crashed, timed_out, no_answer) and reason of `record`
// say why. Leaves in `folder` what the program printed (log.txt), its calibration and, after a crash or with keep_work,
// the folder `work` that it ran in. Throws std::runtime_error and BadInput where it cannot start as its entry says.
ExternalAnswer RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                           const std::string& sequence, const sim::Scenario& scenario, bool rendered,
                           const std::filesystem::path& folder, bool keep_work, campaign::TaskRecord& record);

}  // namespace vobench
