#include "tools/bench/campaign/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/base/files.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/text.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostElements = 1000;  // the default MaxArraySize is 1001
constexpr double kPatience_s = 120;
constexpr int kRounds = 3;  // that may pass without a single new result

struct Answer {
  bool good = false;
  std::string text;  // to both streams
};

Answer Ask(const std::string& command, const fs::path& where) {
  const fs::path log = where / "answer.txt";
  const CommandEnd end = RunCommand(command, where, log, kPatience_s);
  return {!end.timed_out && end.signal == 0 && end.status == 0, base::ReadFile(log).value_or("")};
}

class SlurmRun {
 public:
  SlurmRun(const CampaignWork& work, const CampaignOptions& options, std::vector<std::int64_t> tasks)
      : work_(work),
        options_(options),
        out_(fs::absolute(options.output)),
        folder_(out_ / "slurm"),
        name_(SlurmJobName(out_)),
        left_(std::move(tasks)),
        progress_("tasks", static_cast<std::int64_t>(left_.size()), 0, "tasks") {}

  void Run() {
    fs::create_directories(folder_);
    const FileLock alone = LockOutput(folder_, FileLock::Kind::exclusive);
    const Answer earlier = AskForJobs();
    if (!earlier.good) {
      throw std::runtime_error(fmt::format(
          "squeue does not say whether jobs of an earlier start ({}) are in the queue, so nothing was submitted: {}",
          name_, earlier.text.empty() ? "it does not answer" : earlier.text));
    }
    if (!IsGone(earlier)) {
      fmt::print(stderr, "jobs of an earlier start ({}) are in the queue: waiting for them\n", name_);
      WaitForJobs();
    }
    for (int fruitless = 0; !left_.empty() && fruitless < kRounds;) {
      const std::size_t before = left_.size();
      SubmitRest();
      WaitForJobs();
      if (left_.size() == before) ++fruitless;
    }
    for (const std::int64_t task : left_) {
      work_.RecordFailure(out_, task,
                          fmt::format("no result from Slurm in {} rounds; its logs are in OUT/slurm", kRounds));
      progress_.Step();
    }
  }

 private:
  // Invalid where the controller does not answer, or there is no squeue here.
  Answer AskForJobs() const { return Ask("squeue --noheader --format=%A --name=" + name_, folder_); }
  // Whether no job of this name is left, queued or at work.
  static bool IsGone(const Answer& jobs) {
    return jobs.good && jobs.text.find_first_of("0123456789") == std::string::npos;
  }

  void SubmitRest() {
    const std::vector<std::string> lines = ArrayLines(BySequence(), options_.tasks_per_job);
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    const fs::path list = folder_ / "tasks.txt", script = folder_ / "job.sh";
    base::WriteFile(list, text, base::Writers::many);
    const auto word = [](const fs::path& path) { return QuotedForShell(fs::absolute(path).string()); };
    std::string command = fmt::format("{} campaign {} -o {} --cache {}", word(fs::read_symlink("/proc/self/exe")),
                                      word(options_.file), word(out_), word(work_.cache().folder()));
    if (options_.memory_bytes > 0) command += fmt::format(" --memory {}", options_.memory_bytes);
    if (options_.timeout_s > 0) command += fmt::format(" --timeout {}", options_.timeout_s);
    command += fmt::format(" --jobs 1 --list {} --part", word(list));
    base::WriteFile(script, BatchScript(options_, name_, lines.size(), folder_, command), base::Writers::many);
    const Answer answer = Ask("sbatch --parsable " + QuotedForShell(script.string()), folder_);
    if (!answer.good) throw std::runtime_error("sbatch: " + answer.text);
  }

  // An element of the array does tasks on the same pictures, so that its node reads them from the disk once.
  std::vector<std::int64_t> BySequence() const {
    std::vector<std::pair<std::size_t, std::int64_t>> tasks;
    for (const std::int64_t task : left_) tasks.emplace_back(ChoiceOf(work_.campaign(), task).point, task);
    std::sort(tasks.begin(), tasks.end());
    std::vector<std::int64_t> sorted;
    for (const auto& [point, task] : tasks) sorted.push_back(task);
    return sorted;
  }

  // Until the last result is there, or no job is left.
  void WaitForJobs() {
    using std::chrono::milliseconds;
    for (milliseconds pause(200);; pause = std::min(pause * 5 / 4, milliseconds(10'000))) {
      const bool is_gone = IsGone(AskForJobs());
      Collect();
      if (left_.empty() || is_gone) return;
      for (milliseconds slept(0); slept < pause; slept += milliseconds(100)) {
        if (InterruptPending()) throw Interrupted(name_);
        std::this_thread::sleep_for(milliseconds(100));
      }
    }
  }

  void Collect() {
    const std::vector<std::int64_t> present = PresentTasks(out_);
    const auto done = [&](std::int64_t task) { return std::binary_search(present.begin(), present.end(), task); };
    const auto count = static_cast<std::int64_t>(std::erase_if(left_, done));
    if (count > 0) progress_.Step(count);
  }

  const CampaignWork& work_;
  const CampaignOptions& options_;
  fs::path out_, folder_;
  std::string name_;
  std::vector<std::int64_t> left_;
  Progress progress_;
};

}  // namespace

void RunOnSlurm(const CampaignWork& work, const CampaignOptions& options, std::vector<std::int64_t> tasks) {
  if (tasks.empty()) return;
  RemoveFailed(options.output, tasks);  // results that exist from now on are new
  SlurmRun(work, options, std::move(tasks)).Run();
}

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

std::string BatchScript(const CampaignOptions& options, const std::string& name, std::size_t elements,
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

}  // namespace vobench::campaign
