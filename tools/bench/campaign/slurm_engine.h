// Slurm engine: tasks are submitted as a job array, waited for, and missing ones submitted again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tools/bench/campaign/options.h"
#include "tools/bench/campaign/work.h"

namespace vobench::campaign {

// Every one of these tasks has a result afterwards, failed ones theirs. Jobs that an earlier start has submitted are
// waited for first. Throws Interrupted, and leaves the jobs in the queue; std::runtime_error with sbatch's own words.
void RunOnSlurm(const CampaignWork& work, const CampaignOptions& options, std::vector<std::int64_t> tasks);

}  // namespace vobench::campaign
