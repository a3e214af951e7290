#include "tools/bench/campaign/process_pool.h"

#include <fmt/format.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr int kWorkFailed = 3;  // exit status

// Memory counted by RLIMIT_DATA that is already in use: of the program and its libraries. [bytes]
std::uint64_t DataNow() {
  std::ifstream stream("/proc/self/statm");
  std::uint64_t pages[6] = {};  // the last: data and stack
  for (std::uint64_t& value : pages) stream >> value;
  return pages[5] * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void SetLimits(const ProcessLimits& limits) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (limits.memory_bytes == 0) return;
  const rlim_t most = DataNow() + limits.memory_bytes;
  const rlimit memory{most, most};
  setrlimit(RLIMIT_DATA, &memory);
}

std::string OutOfMemory(const ProcessLimits& limits) {
  if (limits.memory_bytes == 0) return "out of memory";
  return fmt::format("out of memory: more than the {:.3g} GB of --memory",
                     static_cast<double>(limits.memory_bytes) * 1e-9);
}

// Returns the exit status; its problem goes to `answer`.
int Do(const std::function<void()>& work, const ProcessLimits& limits, int answer) {
  int status = 0;
  std::string problem;
  try {
    work();
  } catch (const std::bad_alloc&) {
    status = 1;
    problem = OutOfMemory(limits);
  } catch (const std::invalid_argument& error) {
    status = 1;
    problem = error.what();
  } catch (const std::exception& error) {
    status = kWorkFailed;
    problem = error.what();
  }
  constexpr std::size_t kFitsIntoAPipe = 4000;
  if (base::WriteAll(answer, problem.substr(0, kFitsIntoAPipe)) != 0) return 2;
  std::fflush(nullptr);
  return status;
}

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t NumberIn(const fs::path& file) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? value : kUnknown;  // "max", too
}

// Of a line "NAME VALUE ...".
std::uint64_t NumberOf(const std::string& name, const fs::path& file) {
  std::ifstream stream(file);
  for (std::string word; stream >> word;) {
    std::uint64_t value = 0;
    if (word == name && stream >> value) return value;
  }
  return kUnknown;
}

// The control group (v2) of this process, "/" being that of which the files are in sys/fs/cgroup itself.
fs::path OwnGroup(const fs::path& root) {
  std::ifstream stream(root / "proc/self/cgroup");
  const std::string v2 = "0::";
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(v2)) return fs::path(line.substr(v2.size())).lexically_normal();
  }
  return "/";
}

// Memory left in a group; inactive file cache counts as free.
std::uint64_t LeftIn(const fs::path& group) {
  const std::uint64_t most = NumberIn(group / "memory.max"), taken = NumberIn(group / "memory.current");
  if (most == kUnknown || taken == kUnknown) return kUnknown;
  const std::uint64_t cache = NumberOf("inactive_file", group / "memory.stat");
  const std::uint64_t used = cache == kUnknown ? taken : taken - std::min(taken, cache);
  return most - std::min(most, used);
}

}  // namespace

ProcessPool::~ProcessPool() {
  for (const Running& process : running_) process.child.Kill();
  for (const Running& process : running_) {
    process.child.Wait();
    process.child.ReadAnswer();  // ends when all that it has started (RunCommand) is gone
  }
}

void ProcessPool::Start(std::int64_t id, const ProcessLimits& limits, const std::function<void()>& work) {
  std::fflush(nullptr);  // or both processes would write the buffered output
  base::ChildProcess child([&](int answer) {
    running_.clear();  // closes the others' pipes
    SetLimits(limits);
    return Do(work, limits, answer);
  });
  const auto deadline = limits.timeout_s > 0 ? base::After(limits.timeout_s) : base::SteadyTime::max();
  running_.push_back({id, std::move(child), deadline, limits.timeout_s, false});
}

std::string ProcessPool::ProblemOf(const Running& process, const base::ExitStatus& end) {
  const std::string answer = process.child.ReadAnswer().value_or("");
  if (end.signal == 0 && end.status == 0) return "";
  if (process.killed) return fmt::format("took longer than the {:g} s of --timeout", process.timeout_s);
  if (end.signal != 0) return fmt::format("ended by signal {} ({})", end.signal, strsignal(end.signal));
  return answer.empty() ? fmt::format("ended with status {}", end.status) : answer;
}

std::optional<ProcessEnd> ProcessPool::Wait(std::chrono::milliseconds patience) {
  const base::SteadyTime until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    for (auto process = running_.begin(); process != running_.end(); ++process) {
      const std::optional<base::ExitStatus> end = process->child.Poll();
      if (!end) continue;
      const ProcessEnd ended{process->id, ProblemOf(*process, *end), end->status == kWorkFailed};
      running_.erase(process);
      return ended;
    }
    const base::SteadyTime now = std::chrono::steady_clock::now();
    base::SteadyTime next = until;
    for (Running& process : running_) {
      if (process.killed) continue;
      next = std::min(next, process.deadline);
      if (process.deadline > now) continue;
      process.killed = true;
      process.child.Kill();
    }
    if (now >= until || running_.empty()) return std::nullopt;
    base::WaitForSignal(base::SignalSet({SIGCHLD}), next);
  }
}

std::uint64_t AvailableMemory(const fs::path& root) {
  const std::uint64_t kilobytes = NumberOf("MemAvailable:", root / "proc/meminfo");
  std::uint64_t available = kilobytes == kUnknown ? kUnknown : kilobytes * 1024;
  // A group is also limited by the groups above it.
  for (fs::path group = OwnGroup(root);; group = group.parent_path()) {
    available = std::min(available, LeftIn(root / "sys/fs/cgroup" / group.relative_path()));
    if (!group.has_relative_path()) return available;
  }
}

Share ShareOut(std::uint64_t available, int wanted, std::uint64_t each) {
  if (each == 0 && available == kUnknown) return {wanted, {}};
  if (each == 0) return {wanted, {std::max<std::uint64_t>(1, available / static_cast<std::uint64_t>(wanted))}};
  const std::uint64_t fit = std::max<std::uint64_t>(1, available / each);
  return {static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(wanted), fit)), {each}};
}

}  // namespace vobench::campaign
