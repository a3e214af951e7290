// Pool of forked processes, as many as fit into memory: one that crashes, hangs or exceeds its share ends alone. For
// use before this process has threads, which a fork does not copy.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
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
  bool work_failed = false;  // it threw something else than std::invalid_argument, which means invalid input
};

class ProcessPool {
 public:
  ProcessPool() = default;
  // Kills running processes, and waits for them and for the commands that they run.
  ~ProcessPool();
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  // Forks a process that runs work(); an exception of it becomes its problem. It is killed when this process ends.
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

  base::SignalBlock child_ends_{base::SignalSet({SIGCHLD})};  // it waits for Wait()
  std::vector<Running> running_;
};

// Memory available without swapping: of the machine, or of the control groups (v2) of this process. The files of the
// system are below `root`. [bytes]
std::uint64_t AvailableMemory(const std::filesystem::path& root = "/");

struct Share {
  int processes = 1;     // at a time
  ProcessLimits limits;  // of each; memory 0: no limit, where the amount that is available is unknown
};

// `wanted` processes of `each` bytes, or as many as fit, one at least. each = 0: an equal part of what is available,
// never 0 of it.
Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each);

}  // namespace vobench::campaign
