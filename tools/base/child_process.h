// Child processes on POSIX: fork, a pipe for the answer, waiting with a deadline.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>

#include "tools/base/files.h"

namespace base {

using SteadyTime = std::chrono::steady_clock::time_point;

SteadyTime After(double seconds);

sigset_t SignalSet(std::initializer_list<int> signals);

// Blocks signals of this thread; the destructor restores its mask.
class SignalBlock {
 public:
  explicit SignalBlock(const sigset_t& signals) { pthread_sigmask(SIG_BLOCK, &signals, &before_); }
  ~SignalBlock() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalBlock(const SignalBlock&) = delete;
  SignalBlock& operator=(const SignalBlock&) = delete;

 private:
  sigset_t before_;
};

// The next signal of a blocked set; none at `until`, or when another signal interrupts the wait.
std::optional<int> WaitForSignal(const sigset_t& signals, SteadyTime until);

// fork(2), of a process that is sent `signal` when the calling thread ends.
pid_t ForkTied(int signal);

struct ExitStatus {
  int status = 0;
  int signal = 0;  // that ended the process; 0: it exited
};

// A forked process that is killed when the calling thread ends. The destructor neither kills nor waits. Of the threads
// of this process only the calling one exists in the child.
class ChildProcess {
 public:
  // Runs work(answer) in the child; `answer` is the write end of a pipe, the result the exit status, 1 for an
  // exception.
  // Throws std::system_error when no process can be started.
  explicit ChildProcess(const std::function<int(int answer)>& work);

  // Output of the child, and of those that inherit its pipe, until all of them have closed it; none at `until`.
  // For `expected` bytes, memory and a larger pipe are reserved.
  std::optional<std::string> ReadAnswer(SteadyTime until = SteadyTime::max(), std::size_t expected = 0) const;

  void Kill() const { kill(pid_, SIGKILL); }
  ExitStatus Wait() const;
  // Wait for a child that has ended; none while it runs.
  std::optional<ExitStatus> Poll() const;

 private:
  Descriptor answer_;
  pid_t pid_ = -1;
};

}  // namespace base
