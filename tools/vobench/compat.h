// Purpose: `vobench evaluate --compat`: which tool's output is asked for, with that tool's own options.
// Source:  docs/metrics.md, "Other tools' numbers".
#pragma once

#include <functional>
#include <string>

#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

struct Reproduction {
  evaluation::Reading reading = evaluation::Reading::strict;  // how the tool reads its files
  // The tool's output. Throws evaluation::InputError.
  std::function<std::string(const evaluation::Trajectory& estimate, const evaluation::Trajectory& truth)> Run;
};

// "tum", "tum ate --verbose", "evo rpe --delta 10 --all_pairs", ...: throws BadInput saying what there is.
Reproduction ParseCompat(const std::string& request);

}  // namespace vobench
