// Job arrays of Slurm through its own commands sbatch and squeue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vobench::campaign {

struct SlurmOptions {
  std::string partition;  // empty: the cluster's default
  std::string time;       // of a job, as sbatch has it: "2:00:00"; empty: the partition's
  std::uint64_t memory_bytes = 0;
  int tasks_per_job = 10;
};

// The name of a campaign's jobs: another for each folder.
std::string SlurmJobName(const std::filesystem::path& out);

// One line for each element of the array: its tasks, in order. No more lines than Slurm allows in an array as it comes.
std::vector<std::string> ArrayLines(const std::vector<std::int64_t>& tasks, int tasks_per_job);
// The tasks of line `part` of such a file. Throws std::invalid_argument.
std::vector<std::int64_t> ReadArrayLine(const std::filesystem::path& list, std::size_t part);

// The batch script of the array: each element runs `command` with its number behind it.
std::string BatchScript(const SlurmOptions& options, const std::string& name, std::size_t elements,
                        const std::filesystem::path& logs, const std::string& command);

// Submits it, from the folder `where`. Throws std::runtime_error with sbatch's own words.
void Submit(const std::filesystem::path& script, const std::filesystem::path& where);

enum class SlurmState {
  queued,   // or at work
  gone,     // no job of this name is left
  unknown,  // the controller does not answer, or there is no squeue here
};
struct SlurmAnswer {
  SlurmState state = SlurmState::unknown;
  std::string words;  // squeue's own
};
SlurmAnswer AskForJobs(const std::string& name, const std::filesystem::path& where);

}  // namespace vobench::campaign
