#include "tools/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

namespace base {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kPipe = 1 << 16, kLargePipe = 1 << 20;  // Linux gives the first [bytes]

ExitStatus StatusOf(int status) {
  return WIFSIGNALED(status) ? ExitStatus{0, WTERMSIG(status)} : ExitStatus{WEXITSTATUS(status), 0};
}

template <class Duration>
Duration Left(SteadyTime until) {
  return std::chrono::ceil<Duration>(std::max(until - steady_clock::now(), steady_clock::duration::zero()));
}

}  // namespace

SteadyTime After(double seconds) {
  return steady_clock::now() +
         std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
}

sigset_t SignalSet(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  return set;
}

std::optional<int> WaitForSignal(const sigset_t& signals, SteadyTime until) {
  const auto left = Left<std::chrono::nanoseconds>(until).count();
  const timespec wait{left / 1'000'000'000, left % 1'000'000'000};
  const int signal = sigtimedwait(&signals, nullptr, &wait);
  return signal > 0 ? std::optional(signal) : std::nullopt;
}

pid_t ForkTied(int signal) {
  const pid_t parent = getpid(), child = fork();
  if (child != 0) return child;
  prctl(PR_SET_PDEATHSIG, signal);
  if (getppid() != parent) _exit(1);  // the parent has already ended
  return child;
}

ChildProcess::ChildProcess(const std::function<int(int answer)>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  answer_ = Descriptor(ends[0]);
  Descriptor to_parent(ends[1]);
  pid_ = ForkTied(SIGKILL);
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
  if (pid_ > 0) return;
  answer_.Close();
  try {
    _exit(work(*to_parent));
  } catch (...) {
    _exit(1);
  }
}

std::optional<std::string> ChildProcess::ReadAnswer(SteadyTime until, std::size_t expected) const {
  std::string answer, block(std::clamp(expected, kPipe, kLargePipe), 0);
  if (block.size() > kPipe) fcntl(*answer_, F_SETPIPE_SZ, static_cast<int>(block.size()));  // a small one is slower
  answer.reserve(expected);
  for (;;) {
    pollfd end{*answer_, POLLIN, 0};
    const auto left = Left<std::chrono::milliseconds>(until).count();
    const int wait = static_cast<int>(std::min<std::int64_t>(left, std::numeric_limits<int>::max()));
    const int ready = poll(&end, 1, until == SteadyTime::max() ? -1 : wait);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return std::nullopt;
    const ssize_t got = Uninterrupted([&] { return read(*answer_, block.data(), block.size()); });
    if (got < 0) return std::nullopt;
    if (got == 0) return answer;
    answer.append(block, 0, static_cast<std::size_t>(got));
  }
}

ExitStatus ChildProcess::Wait() const {
  int status = 0;
  Uninterrupted([&] { return waitpid(pid_, &status, 0); });
  return StatusOf(status);
}

std::optional<ExitStatus> ChildProcess::Poll() const {
  int status = 0;
  return waitpid(pid_, &status, WNOHANG) == pid_ ? std::optional(StatusOf(status)) : std::nullopt;
}

}  // namespace base
