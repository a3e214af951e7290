// Ctrl-C and SIGTERM, noticed between two frames, so that destructors run and nothing half-written stays.
#pragma once

namespace vobench {

// From now on SIGINT, SIGTERM and SIGHUP wait to be asked for. Call once, before any thread starts: threads inherit it.
void HoldInterrupts();
// Whether one of them waits.
bool InterruptPending();

}  // namespace vobench
