// Progress bar on a terminal, and Ctrl-C during work of known and unknown length.
#include "tools/bench/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "tools/bench/errors.h"

namespace vobench {
namespace {

using testing::HasSubstr;

// Pseudo-terminal in place of stderr, for the object's lifetime.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)), before_(dup(STDERR_FILENO)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) throw std::runtime_error("no pseudo-terminal");
    const int slave = open(ptsname(master_), O_RDWR | O_NOCTTY);
    dup2(slave, STDERR_FILENO);
    close(slave);
  }
  ~Terminal() {
    dup2(before_, STDERR_FILENO);
    close(before_);
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Output since the last call.
  std::string Shown() const {
    char text[4096];
    const ssize_t got = read(master_, text, sizeof text);
    return {text, static_cast<std::size_t>(got > 0 ? got : 0)};
  }

 private:
  int master_, before_;
};

TEST(Progress, TheBarEndsFull) {
  const Terminal terminal;
  Progress progress("tracking", 2);
  progress.Step(2);
  EXPECT_THAT(terminal.Shown(), HasSubstr("tracking [" + std::string(30, '#') + "] 2/2, took 0:00"));
}

TEST(Progress, MoreThanTheTotalIsSaidAndTheBarStaysFull) {
  const Terminal terminal;
  Progress progress("tracking", 2);  // too small a total, as a video file may have
  progress.Step(2);
  progress.Step();
  EXPECT_THAT(terminal.Shown(), HasSubstr("tracking [" + std::string(30, '#') + "] 3/2, took 0:0"));
  std::this_thread::sleep_for(std::chrono::milliseconds(150));  // redrawn after some time, too
  progress.Step(100);
  EXPECT_THAT(terminal.Shown(), HasSubstr("tracking [" + std::string(30, '#') + "] 103/2, took 0:0"));
}

// Pending SIGINT, blocked as in the program.
class PendingInterrupt {
 public:
  PendingInterrupt() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
    raise(SIGINT);
  }
  ~PendingInterrupt() {
    int signal = 0;
    sigwait(&set_, &signal);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  PendingInterrupt(const PendingInterrupt&) = delete;
  PendingInterrupt& operator=(const PendingInterrupt&) = delete;

 private:
  sigset_t set_{}, before_{};
};

TEST(Progress, CtrlCOfAKnownEnd) {
  const PendingInterrupt interrupt;
  Progress film("tracking", 2), camera("tracking", 0);
  EXPECT_THROW(film.Step(), Interrupted);
  EXPECT_NO_THROW(camera.Step());
}

}  // namespace
}  // namespace vobench
