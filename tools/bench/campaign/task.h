// Purpose: one task of a campaign: played or tracked, judged, and written to its folder. A function of the campaign's
//          file and the task's number, but for the times.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/bench/campaign/work.h"

namespace vobench {

// Into OUT/tasks/...; an older result goes. The sequence that it needs must be in the cache. Works with one thread.
// Throws BadInput, std::runtime_error: then nothing is written.
void RunTask(const CampaignWork& work, const std::filesystem::path& out, std::int64_t task);

// Nothing could be found out, and why.
void RecordFailure(const CampaignWork& work, const std::filesystem::path& out, std::int64_t task,
                   const std::string& reason);

}  // namespace vobench
