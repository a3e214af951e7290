#include "tools/bench/campaign/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/campaign/digest.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostElements = 1000;  // MaxArraySize is 1001 unless the cluster says otherwise
constexpr double kPatience_s = 120;

struct Answer {
  bool good = false;
  std::string text;  // to both streams
};

Answer Ask(const std::string& command, const fs::path& where) {
  const fs::path log = where / "answer.txt";
  const CommandEnd end = RunCommand(command, where, log, kPatience_s);
  return {!end.timed_out && end.signal == 0 && end.status == 0, base::ReadFile(log).value_or("")};
}

}  // namespace

std::string SlurmJobName(const fs::path& out) {
  return "vobench-" + Digest(fs::weakly_canonical(out).string()).substr(0, 12);
}

std::vector<std::string> ArrayLines(const std::vector<std::int64_t>& tasks, int tasks_per_job) {
  const std::size_t least = (tasks.size() + kMostElements - 1) / kMostElements;
  const std::size_t each = std::max(static_cast<std::size_t>(tasks_per_job), least);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (i % each == 0) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + std::to_string(tasks[i]);
  }
  return lines;
}

std::vector<std::int64_t> ReadArrayLine(const fs::path& list, std::size_t part) {
  std::ifstream stream(list);
  std::string line;
  for (std::size_t i = 0; i <= part; ++i) {
    if (!std::getline(stream, line)) {
      throw std::invalid_argument(fmt::format("{}: has no line {} (the first is 0)", list.string(), part));
    }
  }
  std::istringstream numbers(line);
  std::vector<std::int64_t> tasks{std::istream_iterator<std::int64_t>(numbers), {}};
  if (!numbers.eof()) throw std::invalid_argument(list.string() + ": not a list of tasks: " + line);
  return tasks;
}

std::string BatchScript(const SlurmOptions& options, const std::string& name, std::size_t elements,
                        const fs::path& logs, const std::string& command) {
  std::string script = fmt::format("#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --array=0-{}\n#SBATCH --output=\"{}\"\n",
                                   name, elements - 1, (logs / "%A_%a.log").string());
  script += "#SBATCH --cpus-per-task=1\n#SBATCH --requeue\n#SBATCH --open-mode=append\n";
  if (!options.partition.empty()) script += "#SBATCH --partition=" + options.partition + "\n";
  if (!options.time.empty()) script += "#SBATCH --time=" + options.time + "\n";
  if (options.memory_bytes > 0) {
    constexpr std::uint64_t kMegabyte = 1 << 20, kProgram = 256;  // libraries and the process that waits
    script += fmt::format("#SBATCH --mem={}M\n", options.memory_bytes / kMegabyte + kProgram);
  }
  return script + "exec " + command + " \"$SLURM_ARRAY_TASK_ID\"\n";
}

void Submit(const fs::path& script, const fs::path& where) {
  const Answer answer = Ask("sbatch --parsable " + QuotedForShell(script.string()), where);
  if (!answer.good) throw std::runtime_error("sbatch: " + answer.text);
}

SlurmAnswer AskForJobs(const std::string& name, const fs::path& where) {
  const Answer answer = Ask("squeue --noheader --format=%A --name=" + name, where);
  if (!answer.good) return {SlurmState::unknown, answer.text};
  const bool is_none = answer.text.find_first_of("0123456789") == std::string::npos;
  return {is_none ? SlurmState::gone : SlurmState::queued, answer.text};
}

}  // namespace vobench::campaign
