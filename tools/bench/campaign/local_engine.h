// Local engine: sequences are rendered first, then tasks run, each in its own process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tools/bench/campaign/process_pool.h"
#include "tools/bench/campaign/work.h"

namespace vobench::campaign {

struct LocalOptions {
  int jobs = 1;          // processes at a time
  ProcessLimits limits;  // of each; rendering has no time-out
};

// Every one of these tasks has a result afterwards, failed ones theirs. Sequences have their names. Throws Interrupted;
// what is done by then stays. No thread may have been started before.
void RunLocally(const CampaignWork& work, const std::filesystem::path& out, const std::vector<std::int64_t>& tasks,
                const LocalOptions& options);

}  // namespace vobench::campaign
