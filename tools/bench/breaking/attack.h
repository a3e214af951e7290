// `vobench bench --attack`: the search of attack_search.h with the real system, and the scenario that it finds.
#pragma once

#include "tools/bench/breaking/bench_file.h"
#include "tools/bench/breaking/options.h"

namespace vobench::breaking {

// Each evaluation is a campaign OUT/trials/..., whose majority of seeds says whether the combination breaks the system.
// What is found is run in ten other worlds, and made more severe until nine of them are broken. Prints it, and writes
// attack.yaml, a campaign that reproduces it, and attack.json. Throws BadInput where the file has no parameters.
void RunAttack(const BenchOptions& options, const BenchFile& bench);

}  // namespace vobench::breaking
