#include "tools/campaign/command.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>

namespace campaign {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void Become(const std::string& command, const std::filesystem::path& folder, int log, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(folder.c_str()) != 0 || dup2(nothing, 0) < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0) _exit(127);
  execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

}  // namespace

CommandEnd RunCommand(const std::string& command, const std::filesystem::path& folder, const std::filesystem::path& log,
                      double timeout_s) {
  const auto fail = [](const std::string& what) {
    throw std::runtime_error(what + ": " + std::generic_category().message(errno));
  };
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(log.string() + ": cannot be made");
  const auto close_log = [&] { close(file); };
  const Clock::time_point start = Clock::now();
  const auto limit = start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
  const pid_t parent = getpid(), child = fork();
  if (child < 0) close_log(), fail("cannot start a process");
  if (child == 0) Become(command, folder, file, parent);
  setpgid(child, child);  // both sides say so: whichever comes first
  close_log();

  sigset_t child_ends, before;
  sigemptyset(&child_ends);
  sigaddset(&child_ends, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child_ends, &before);
  CommandEnd end;
  // WNOWAIT: while it is not waited for, its number and its group's belong to nobody else.
  siginfo_t info{};
  while (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(limit - Clock::now());
    if (left.count() <= 0) {
      end.timed_out = true;
      break;
    }
    const timespec wait{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    sigtimedwait(&child_ends, nullptr, &wait);
  }
  kill(-child, SIGKILL);  // and whatever it has left behind
  int status = 0;
  waitpid(child, &status, 0);
  sigprocmask(SIG_SETMASK, &before, nullptr);
  end.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
  constexpr int kShellSaysSignal = 128;  // and which, of a command that it waited for
  if (end.status > kShellSaysSignal && end.status < kShellSaysSignal + NSIG) {
    end.signal = end.status - kShellSaysSignal;
  }
  return end;
}

std::string QuotedForShell(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace campaign
