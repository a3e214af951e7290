#include "tools/bench/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/base/child_process.h"
#include "tools/bench/errors.h"

namespace vobench {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr auto kPlainLine = std::chrono::seconds(10);

double Seconds(std::chrono::steady_clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

sigset_t Signals() { return base::SignalSet({SIGINT, SIGTERM, SIGHUP}); }

}  // namespace

void HoldInterrupts() {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // Writing to a closed pipe (`vobench ... | head`) is an error, not the end of the program.
  signal(SIGPIPE, SIG_IGN);
}

bool InterruptPending() {
  const sigset_t signals = Signals();
  sigset_t pending, ours;
  sigpending(&pending);
  sigandset(&ours, &pending, &signals);
  return sigisemptyset(&ours) == 0;
}

Progress::Progress(std::string what, std::int64_t total, std::int64_t done, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      before_(done),
      done_(done),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {
  if (terminal_ || total_ == 0) return;
  fmt::print(stderr, "{}: {} {}", what_, total_, unit_);
  if (before_ > 0) fmt::print(stderr, ", {} of them are there", before_);
  fmt::print(stderr, "\n");
}

Progress::~Progress() {
  if (terminal_ && done_ > before_) std::fputc('\n', stderr);
}

void Progress::Step(std::int64_t count) {
  done_ += count;
  const auto now = std::chrono::steady_clock::now();
  const bool is_time = terminal_ ? now - drawn_ >= kRedraw : now - drawn_ >= kPlainLine;
  const bool is_beyond = terminal_ && total_ > 0 && done_ > total_;  // the last step is unknown
  if (done_ == total_ || is_beyond || is_time) {
    drawn_ = now;
    Draw();
  }
  if (total_ > 0 && InterruptPending()) throw Interrupted(what_ + " was interrupted; nothing was kept");
}

void Progress::Draw() const {
  const double elapsed = Seconds(drawn_ - start_);
  if (total_ == 0 || !terminal_) {
    const std::string of = total_ == 0 ? "" : fmt::format("/{}", total_);
    fmt::print(stderr, "{}{}: {}{} {}, {}{}", terminal_ ? "\r" : "", what_, done_, of, unit_, Duration(elapsed),
               terminal_ ? "    " : "\n");
    return;
  }
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * std::min(done_, total_) / total_);
  const double left = elapsed / static_cast<double>(done_ - before_) * static_cast<double>(total_ - done_);
  const std::string time = done_ >= total_ ? "took " + Duration(elapsed) : Duration(left) + " left";
  fmt::print(stderr, "\r{} [{}{}] {}/{}, {}    ", what_, std::string(static_cast<std::size_t>(filled), '#'),
             std::string(static_cast<std::size_t>(kWidth - filled), '.'), done_, total_, time);
}

std::string Duration(double seconds) {
  const std::int64_t whole = std::llround(seconds);
  const std::int64_t h = whole / 3600, m = whole / 60 % 60, s = whole % 60;
  return h > 0 ? fmt::format("{}:{:02}:{:02}", h, m, s) : fmt::format("{}:{:02}", m, s);
}

}  // namespace vobench
