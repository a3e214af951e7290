// Purpose: what decides the exit status: BadInput is the caller's to mend (2), NotConsistent is an answer that was
// asked
//          to be another (3), every other exception means that the work failed (1).
#pragma once

#include <new>
#include <stdexcept>
#include <utility>

namespace vobench {

struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The work is done and written; a system is not consistent with its own model though that was required.
struct NotConsistent : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The streams of a sequence disagree; the work failed (1), and what disagrees has been printed.
struct Inconsistent : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A campaign is done but for tasks that failed (exit 1); the message names the first.
struct TasksFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The work was stopped by a signal (exit 1); the message says what was kept.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Reads an input: whatever goes wrong in there is the input's fault. The libraries' messages name file, line and value.
template <class Function>
auto Input(Function&& read) {
  try {
    return std::forward<Function>(read)();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw BadInput(error.what());
  }
}

}  // namespace vobench
