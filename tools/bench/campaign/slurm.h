// Slurm engine: tasks are submitted as a job array (sbatch), waited for (squeue), and missing ones submitted again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/campaign/options.h"
#include "tools/bench/campaign/work.h"

namespace vobench::campaign {

// Afterwards each of these tasks has a result, possibly `failed`. Jobs submitted by an earlier start are waited for
// first. Throws Interrupted, and leaves the jobs in the queue; std::runtime_error with sbatch's own message.
void RunOnSlurm(const CampaignWork& work, const CampaignOptions& options, std::vector<std::int64_t> tasks);

// The name of a campaign's jobs: distinct for each folder.
std::string SlurmJobName(const std::filesystem::path& out);

// One line for each element of the array: its tasks, in order. At most as many lines as Slurm's default array limit.
std::vector<std::string> ArrayLines(const std::vector<std::int64_t>& tasks, int tasks_per_job);
// The tasks of line `part` of such a file. Throws std::invalid_argument.
std::vector<std::int64_t> ReadArrayLine(const std::filesystem::path& list, std::size_t part);

// The batch script of the array: each element runs `command` with its number behind it.
std::string BatchScript(const CampaignOptions& options, const std::string& name, std::size_t elements,
                        const std::filesystem::path& logs, const std::string& command);

}  // namespace vobench::campaign
