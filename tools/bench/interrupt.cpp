#include "tools/bench/interrupt.h"

#include <csignal>

namespace vobench {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

}  // namespace

void HoldInterrupts() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : kSignals) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // A pipe that was closed (`vobench ... | head`) is an error of the write, not the end of the program.
  std::signal(SIGPIPE, SIG_IGN);
}

bool InterruptPending() {
  sigset_t pending;
  sigpending(&pending);
  for (const int signal : kSignals) {
    if (sigismember(&pending, signal) == 1) return true;
  }
  return false;
}

}  // namespace vobench
