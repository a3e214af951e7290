#include "tools/bench/campaign/command.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "tools/base/child_process.h"

namespace vobench::campaign {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kGrace_s = 3;       // from SIGTERM to SIGKILL
constexpr int kNotStarted = 127;     // exit statuses, as shells have them
constexpr int kEndedBySignal = 128;  // and which

// Signal for the leader to end the group. Not SIGTERM: `kill 0` in a script addresses its own processes.
int StopSignal() { return SIGRTMIN; }

[[noreturn]] void Become(const std::string& command, const std::filesystem::path& folder, int log) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(folder.c_str()) != 0 || dup2(nothing, 0) < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0) _exit(kNotStarted);
  execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  _exit(kNotStarted);
}

// Leader of the process group, between the caller and sh, with all signals blocked. It ends as sh does; when the caller
// signals it, or has ended for whatever reason, it sends SIGTERM to the group, and then kills it and itself.
[[noreturn]] void Lead(const std::string& command, const std::filesystem::path& folder, int log) {
  setpgid(0, 0);
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // to be notified of the end of orphans, too
  const pid_t shell = base::ForkTied(SIGKILL);
  if (shell < 0) _exit(kNotStarted);
  if (shell == 0) Become(command, folder, log);
  const sigset_t signals = base::SignalSet({SIGCHLD, StopSignal()});
  std::optional<Clock::time_point> killing;
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(-1, &status, WNOHANG);
    if (ended == shell && !killing) _exit(WIFEXITED(status) ? WEXITSTATUS(status) : kEndedBySignal + WTERMSIG(status));
    if (ended > 0) continue;
    if (ended < 0 || (killing && Clock::now() >= *killing)) kill(0, SIGKILL);
    const std::optional<int> signal = base::WaitForSignal(signals, killing.value_or(base::After(3600)));
    if (signal != StopSignal() || killing) continue;
    killing = base::After(kGrace_s);
    kill(0, SIGTERM);
  }
}

pid_t StartLeader(const std::string& command, const std::filesystem::path& folder, const std::filesystem::path& log) {
  const auto fail = [](const std::string& what) {
    throw std::runtime_error(what + ": " + std::generic_category().message(errno));
  };
  const base::Descriptor file(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file) fail(log.string() + ": cannot be made");
  sigset_t all;
  sigfillset(&all);
  const base::SignalBlock blocked(all);
  const pid_t leader = base::ForkTied(StopSignal());
  if (leader == 0) Lead(command, folder, *file);
  if (leader < 0) fail("cannot start a process");
  setpgid(leader, leader);  // called by both processes: whichever comes first
  return leader;
}

}  // namespace

CommandEnd RunCommand(const std::string& command, const std::filesystem::path& folder, const std::filesystem::path& log,
                      double timeout_s) {
  const Clock::time_point limit = base::After(timeout_s);
  const pid_t leader = StartLeader(command, folder, log);
  const sigset_t child_ends = base::SignalSet({SIGCHLD});
  const base::SignalBlock blocked(child_ends);
  CommandEnd end;
  // WNOWAIT: until it is reaped, its process id and its group's cannot be reused.
  siginfo_t info{};
  while (waitid(P_PID, static_cast<id_t>(leader), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) {
    end.timed_out = Clock::now() >= limit;
    if (end.timed_out) break;
    base::WaitForSignal(child_ends, limit);
  }
  if (end.timed_out) {
    kill(leader, StopSignal());
    waitid(P_PID, static_cast<id_t>(leader), &info, WEXITED | WNOWAIT);
  }
  kill(-leader, SIGKILL);  // what it has left behind
  int status = 0;
  waitpid(leader, &status, 0);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  if (end.status > kEndedBySignal && end.status < kEndedBySignal + NSIG) end.signal = end.status - kEndedBySignal;
  return end;
}

}  // namespace vobench::campaign
