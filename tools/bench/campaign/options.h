// Options and entry point of `vobench campaign`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vobench {

// Scenarios x variants x systems x seeds (docs/campaign.md). When tasks failed, throws std::runtime_error after all
// else is done and written.
struct CampaignOptions {
  std::filesystem::path file;
  std::filesystem::path output;
  std::optional<std::filesystem::path> cache;  // of sequences; OUT/cache unless given
  std::string engine = "local";                // or slurm
  int jobs = 1;                                // processes at a time, here
  std::uint64_t memory_bytes = 0;              // of each; 0: an equal part of what the machine has left
  double timeout_s = 0;                        // of a task; 0: none
  bool dry_run = false;                        // tasks are listed only
  bool update = false;                         // results of other settings may be removed
  std::vector<std::string> redo;               // systems whose results are removed
  std::optional<std::int64_t> task;            // that one alone, again
  std::optional<std::filesystem::path> list;   // those in line `part` of this file
  int part = 0;
  std::string partition, time;  // of Slurm's jobs
  int tasks_per_job = 10;
  bool quiet = false;  // tables are written, not printed
};
void RunCampaign(const CampaignOptions& options);

namespace campaign {
class TaskRunner;
void RunCampaign(const CampaignOptions& options, const TaskRunner& runner);
}  // namespace campaign

}  // namespace vobench
