// Pool of forked processes: one that crashes, hangs or exceeds its memory ends alone. For use before this process has
// threads, which a fork does not copy.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

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
  template <class Work>
  void Start(std::int64_t id, const ProcessLimits& limits, const Work& work) {
    if (Fork(id, limits)) return;
    try {
      work();
      Leave("");
    } catch (const std::bad_alloc&) {
      Leave(OutOfMemory(limits));
    } catch (const std::invalid_argument& error) {
      Leave(error.what());
    } catch (const std::exception& error) {
      Leave(error.what(), kWorkFailed);
    }
  }

  // The next process that ends; none when that takes longer than `patience`. Kills those whose time is over.
  std::optional<ProcessEnd> Wait(std::chrono::milliseconds patience);

  std::size_t running() const { return running_.size(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kWorkFailed = 3;  // exit status
  struct Running {
    std::int64_t id;
    int pid;
    int words;  // a pipe, for its problem
    std::optional<Clock::time_point> deadline;
    double timeout_s;
    bool killed;
  };

  // False in the new process.
  bool Fork(std::int64_t id, const ProcessLimits& limits);
  [[noreturn]] void Leave(const std::string& problem, int status = 1);
  static std::string OutOfMemory(const ProcessLimits& limits);
  static std::string ProblemOf(const Running& process, int status, const std::string& words);

  std::vector<Running> running_;
  int own_words_ = -1;  // in a forked process
  bool blocked_before_ = false;
};

}  // namespace vobench::campaign
