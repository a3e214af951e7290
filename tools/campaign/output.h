// Purpose: the folder of a campaign: who may write to it, which tasks have a result there, and the tables of all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/campaign/file_lock.h"
#include "tools/campaign/plan.h"
#include "tools/campaign/results.h"

namespace campaign {

// Makes the folder, and the mark that says what it is: campaign.json, with `text` where it is new. Throws
// std::invalid_argument where there is something else's folder, std::runtime_error.
void PrepareOutput(const std::filesystem::path& out, const std::string& text);

// Single tasks share the folder, a whole campaign has it for itself. A killed one's processes are given a moment to
// end. Throws std::runtime_error when another one is at work.
FileLock LockOutput(const std::filesystem::path& out, FileLock::Kind kind);

struct OutputState {
  std::vector<std::int64_t> missing;  // and failed
  std::size_t failed = 0;             // of those
  std::vector<std::int64_t> stale;    // of other settings, another program, or beyond the last task
};

// keys[k]: what task k's result must depend on.
OutputState Inspect(const std::filesystem::path& out, const std::vector<std::string>& keys);

void RemoveTasks(const std::filesystem::path& out, const std::vector<std::int64_t>& tasks);

// results.csv, times.csv, tables.md, tables.tex, and curves.csv where the campaign asks for curves, from
// the tasks' folders alone, in order; the records, lost ones by the campaign's rule. All tasks must be there (std::runtime_error).
std::vector<TaskRecord> Merge(const Campaign& campaign, const std::filesystem::path& out);

// Under a name of its own first: several processes may do so.
void WriteAtOnce(const std::filesystem::path& file, const std::string& text);

}  // namespace campaign
