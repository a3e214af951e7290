// `vobench evaluate --compat`: the other tool and its own options, parsed.
// Source: docs/metrics.md, "Other tools' numbers".
#pragma once

#include <string>

#include "tools/bench/run/commands.h"

namespace vobench {

// "tum", "tum ate --verbose", "evo rpe --delta 10 --all_pairs", ...: throws BadInput saying what there is.
Reproduction ParseCompat(const std::string& request);

}  // namespace vobench
