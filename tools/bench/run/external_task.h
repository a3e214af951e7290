// Run of an external program on a cached sequence; a crash or a missing trajectory is a result.
#pragma once

#include <filesystem>
#include <string>

#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/run/served_sequence.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

// Correspondence of a trajectory with the frames of its sequence, within 20 ms each.
struct FramesAnswered {
  std::size_t poses = 0;   // that are those of a frame
  std::size_t frames = 0;  // with a pose
  std::size_t until = 0;   // the number of the last of them, counted from 1
};

// Of stamps that are `factor` times too large.
FramesAnswered CountAnswered(const evaluation::Trajectory& trajectory, const std::vector<std::int64_t>& frame_stamps_ns,
                             std::int64_t factor = 1);

struct ExternalAnswer {
  evaluation::Trajectory trajectory;
  std::vector<std::int64_t> frame_stamps_ns;
  double seconds = 0;  // that the program took
};

// The answer, with record.seed; where there is none, status (crashed, timed_out, no_answer) and reason of `record` are
// set. Leaves in `folder` the program's output (log.txt), its calibration and, after a crash or with keep_work, its
// working folder `work`. Throws std::runtime_error and BadInput where it cannot start as specified.
ExternalAnswer RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                           const std::string& sequence, const sim::Scenario& scenario, bool rendered,
                           const std::filesystem::path& folder, bool keep_work, double focal_error,
                           campaign::TaskRecord& record);

}  // namespace vobench
