#include "tools/bench/campaign/slurm_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/base/files.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/campaign/slurm.h"
#include "tools/bench/campaign/task_folder.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr int kRounds = 3;  // that may pass without a single new result

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
    const SlurmAnswer earlier = AskForJobs(name_, folder_);
    if (earlier.state == SlurmState::unknown) {
      throw std::runtime_error(fmt::format(
          "squeue does not say whether jobs of an earlier start ({}) are in the queue, so nothing was submitted: {}",
          name_, earlier.words.empty() ? "it does not answer" : earlier.words));
    }
    if (earlier.state == SlurmState::queued) {
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
    const SlurmOptions slurm{options_.partition, options_.time, options_.memory_bytes, options_.tasks_per_job};
    base::WriteFile(script, BatchScript(slurm, name_, lines.size(), folder_, command), base::Writers::many);
    Submit(script, folder_);
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
      const SlurmState state = AskForJobs(name_, folder_).state;
      Collect();
      if (left_.empty() || state == SlurmState::gone) return;
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
  RemoveFailed(options.output, tasks);  // what is there from now on is a result
  SlurmRun(work, options, std::move(tasks)).Run();
}

}  // namespace vobench::campaign
