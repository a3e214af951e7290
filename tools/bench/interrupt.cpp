#include "tools/bench/interrupt.h"

#include "tools/base/child_process.h"

namespace vobench {
namespace {

sigset_t Signals() { return base::SignalSet({SIGINT, SIGTERM, SIGHUP}); }

}  // namespace

void HoldInterrupts() {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // A pipe that was closed (`vobench ... | head`) is an error of the write, not the end of the program.
  signal(SIGPIPE, SIG_IGN);
}

bool InterruptPending() {
  const sigset_t signals = Signals();
  sigset_t pending, ours;
  sigpending(&pending);
  sigandset(&ours, &pending, &signals);
  return sigisemptyset(&ours) == 0;
}

}  // namespace vobench
