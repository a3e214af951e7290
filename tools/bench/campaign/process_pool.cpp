#include "tools/bench/campaign/process_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace vobench::campaign {
namespace {

sigset_t ChildEnds() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  return set;
}

// What counts for RLIMIT_DATA and is there already: the program's and its libraries' own. [bytes]
std::uint64_t DataNow() {
  std::ifstream stream("/proc/self/statm");
  std::uint64_t pages[6] = {};  // the last: data and stack
  for (std::uint64_t& value : pages) stream >> value;
  return pages[5] * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::string Gigabytes(std::uint64_t bytes) { return fmt::format("{:.3g} GB", static_cast<double>(bytes) * 1e-9); }

// All of it, whatever interrupts.
std::string ReadAll(int file) {
  std::string text;
  char block[4096];
  for (ssize_t got = 0; (got = read(file, block, sizeof block)) != 0;) {
    if (got > 0) text.append(block, static_cast<std::size_t>(got));
    if (got < 0 && errno != EINTR) break;
  }
  return text;
}

}  // namespace

ProcessPool::ProcessPool() {
  // Blocked, so that it waits for sigtimedwait.
  const sigset_t set = ChildEnds();
  sigset_t before;
  sigprocmask(SIG_BLOCK, &set, &before);
  blocked_before_ = sigismember(&before, SIGCHLD) == 1;
}

ProcessPool::~ProcessPool() {
  for (const Running& process : running_) kill(process.pid, SIGKILL);
  for (const Running& process : running_) {
    waitpid(process.pid, nullptr, 0);
    ReadAll(process.words);  // ends when all that it has started (RunCommand) is gone
    close(process.words);
  }
  const sigset_t set = ChildEnds();
  if (!blocked_before_) sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

bool ProcessPool::Fork(std::int64_t id, const ProcessLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  std::fflush(nullptr);  // or both would write what waits
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) {
    const int error = errno;
    close(ends[0]), close(ends[1]);
    throw std::system_error(error, std::generic_category(), "cannot start a process");
  }
  if (pid > 0) {
    close(ends[1]);
    std::optional<Clock::time_point> deadline;
    if (limits.timeout_s > 0) {
      deadline =
          Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.timeout_s));
    }
    running_.push_back({id, pid, ends[0], deadline, limits.timeout_s, false});
    return true;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  close(ends[0]);
  for (const Running& other : running_) close(other.words);
  running_.clear();
  own_words_ = ends[1];
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (limits.memory_bytes > 0) {
    const rlim_t most = DataNow() + limits.memory_bytes;
    const rlimit memory{most, most};
    setrlimit(RLIMIT_DATA, &memory);
  }
  return false;
}

void ProcessPool::Leave(const std::string& problem, int status) {
  constexpr std::size_t kFitsIntoAPipe = 4000;
  const std::string words = problem.substr(0, kFitsIntoAPipe);
  if (!words.empty() && write(own_words_, words.data(), words.size()) < 0) _exit(2);
  std::fflush(nullptr);
  _exit(problem.empty() ? 0 : status);
}

std::string ProcessPool::OutOfMemory(const ProcessLimits& limits) {
  return limits.memory_bytes == 0 ? "out of memory"
                                  : "out of memory: more than the " + Gigabytes(limits.memory_bytes) + " of --memory";
}

std::string ProcessPool::ProblemOf(const Running& process, int status, const std::string& words) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  if (process.killed) return fmt::format("took longer than the {:g} s of --timeout", process.timeout_s);
  if (WIFSIGNALED(status)) {
    return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  return words.empty() ? fmt::format("ended with status {}", WEXITSTATUS(status)) : words;
}

std::optional<ProcessEnd> ProcessPool::Wait(std::chrono::milliseconds patience) {
  const Clock::time_point until = Clock::now() + patience;
  for (;;) {
    for (auto process = running_.begin(); process != running_.end(); ++process) {
      int status = 0;
      if (waitpid(process->pid, &status, WNOHANG) != process->pid) continue;
      const Running ended = *process;
      running_.erase(process);
      const std::string words = ReadAll(ended.words);
      close(ended.words);
      return ProcessEnd{ended.id, ProblemOf(ended, status, words),
                        WIFEXITED(status) && WEXITSTATUS(status) == kWorkFailed};
    }
    const Clock::time_point now = Clock::now();
    Clock::time_point next = until;
    for (Running& process : running_) {
      if (!process.deadline || process.killed) continue;
      if (*process.deadline <= now) {
        process.killed = true;
        kill(process.pid, SIGKILL);
      } else {
        next = std::min(next, *process.deadline);
      }
    }
    if (now >= until || running_.empty()) return std::nullopt;
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::max(next - now, Clock::duration::zero()));
    const timespec timeout{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    const sigset_t set = ChildEnds();
    sigtimedwait(&set, nullptr, &timeout);
  }
}

}  // namespace vobench::campaign
