// Sequences and tasks of a campaign in processes of this machine.
#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "tools/bench/campaign/work.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/text.h"

namespace vobench::campaign {
namespace {

// A missing sequence, and the tasks that need it.
struct Rendering {
  std::size_t point = 0;  // one of those that show it
  std::vector<std::int64_t> tasks;
};

class LocalRun {
 public:
  LocalRun(const CampaignWork& work, const std::filesystem::path& out, const std::vector<std::int64_t>& tasks,
           const Share& share)
      : work_(work), out_(out), share_(share), tasks_(static_cast<std::int64_t>(tasks.size())) {
    std::map<std::string, std::size_t> known;
    for (const std::int64_t task : tasks) {
      const std::size_t p = ChoiceOf(work.campaign(), task).point;
      const CampaignPoint& point = work.points()[p];
      if (!point.images || work.cache().Has(point.sequence)) {
        ready_.push_back(task);
        continue;
      }
      const auto [at, is_new] = known.try_emplace(point.sequence, renderings_.size());
      if (is_new) renderings_.push_back({p, {}});
      renderings_[at->second].tasks.push_back(task);
    }
  }

  void Run() {
    const auto sequences = static_cast<std::int64_t>(renderings_.size());
    if (sequences > 0)
      fmt::print(stderr, "{} to prepare, then {}\n", Count(renderings_.size(), "sequence"),
                 Count(static_cast<std::size_t>(tasks_), "task"));
    progress_.emplace("campaign", sequences + tasks_, 0, sequences > 0 ? "steps" : "tasks");
    while (next_rendering_ < renderings_.size() || !ready_.empty() || pool_.running() > 0) {
      while (StartOne()) {
      }
      const std::optional<ProcessEnd> end = pool_.Wait(std::chrono::milliseconds(200));
      if (end) Finish(*end);
      if (InterruptPending()) throw Interrupted("interrupted");
    }
  }

 private:
  // Starts one process, sequences first: tasks then keep all processes busy. The last sequences are rendered by several
  // threads where nothing else is to be done.
  bool StartOne() {
    const int free = share_.processes - busy_;
    if (free <= 0) return false;
    if (const std::size_t left = renderings_.size() - next_rendering_; left > 0) {
      const int threads = ready_.empty() ? std::max(1, free / static_cast<int>(left)) : 1;
      const std::size_t index = next_rendering_++;
      ProcessLimits limits = share_.limits;
      limits.timeout_s = 0;
      limits.memory_bytes *= static_cast<std::uint64_t>(threads);
      Start(-1 - static_cast<std::int64_t>(index), threads, limits,
            [&] { work_.Render(renderings_[index].point, threads); });
      return true;
    }
    if (ready_.empty()) return false;
    const std::int64_t task = ready_.front();
    const ExternalSystem& system = work_.campaign().systems[ChoiceOf(work_.campaign(), task).system].external;
    const int threads = std::min(system.threads, share_.processes);
    if (free < threads) return false;
    ready_.pop_front();
    Start(task, threads, share_.limits, [&] { work_.Run(out_, task); });
    return true;
  }

  void Start(std::int64_t id, int slots, const ProcessLimits& limits, const std::function<void()>& work) {
    pool_.Start(id, limits, work);
    slots_[id] = slots;
    busy_ += slots;
  }

  void Finish(const ProcessEnd& end) {
    busy_ -= slots_.at(end.id);
    slots_.erase(end.id);
    progress_->Step();
    if (end.id >= 0) {
      if (!end.problem.empty()) work_.RecordFailure(out_, end.id, end.problem);
      return;
    }
    for (const std::int64_t task : renderings_[static_cast<std::size_t>(-1 - end.id)].tasks) {
      if (end.problem.empty()) {
        ready_.push_back(task);
      } else {
        work_.RecordFailure(out_, task, "its sequence could not be rendered: " + end.problem);
        progress_->Step();
      }
    }
  }

  const CampaignWork& work_;
  const std::filesystem::path& out_;
  const Share& share_;
  std::int64_t tasks_;
  std::optional<Progress> progress_;  // of sequences and tasks
  std::vector<Rendering> renderings_;
  std::size_t next_rendering_ = 0;
  std::deque<std::int64_t> ready_;
  std::map<std::int64_t, int> slots_;  // by task, or -1 - rendering
  int busy_ = 0;
  ProcessPool pool_;
};

}  // namespace

void RunLocally(const CampaignWork& work, const std::filesystem::path& out, const std::vector<std::int64_t>& tasks,
                const Share& share) {
  if (tasks.empty()) return;
  try {
    LocalRun(work, out, tasks, share).Run();
  } catch (const Interrupted&) {  // here or by the progress
    throw Interrupted("the campaign was interrupted; what was done by then stays");
  }
}

}  // namespace vobench::campaign
