// Pool of forked processes: one that crashes, hangs or exceeds its memory ends alone. For use before this process has
// threads, which a fork does not copy.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/base/child_process.h"

namespace vobench::campaign {

struct ProcessLimits {
  std::uint64_t memory_bytes = 0;  // that it may take (RLIMIT_DATA) beside what it starts with; 0: no limit
  double timeout_s = 0;            // wall time, then it is killed; 0: none
};

struct ProcessEnd {
  std::int64_t id = 0;
  std::string problem;       // empty: its work was done
  bool work_failed = false;  // it threw, and nothing that says that its input is wrong (std::invalid_argument)
};

class ProcessPool {
 public:
  ProcessPool();
  // Kills what still runs, and waits for it and for the commands that it runs.
  ~ProcessPool();
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  // Forks a process that does work(); what that throws is its problem. It dies with this one.
  void Start(std::int64_t id, const ProcessLimits& limits, const std::function<void()>& work);

  // The next process that ends; none when that takes longer than `patience`. Kills those whose time is over.
  std::optional<ProcessEnd> Wait(std::chrono::milliseconds patience);

  std::size_t running() const { return running_.size(); }

 private:
  struct Running {
    std::int64_t id;
    base::ChildProcess child;
    base::SteadyTime deadline;
    double timeout_s;
    bool killed;
  };

  static std::string ProblemOf(const Running& process, const base::ExitStatus& end);

  base::SignalBlock child_ends_;  // SIGCHLD waits for Wait()
  std::vector<Running> running_;
};

}  // namespace vobench::campaign
