// Progress of long work on stderr, a bar with the remaining time on a terminal and plain lines otherwise; and Ctrl-C,
// handled between two steps, so that destructors run and no incomplete file stays.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace vobench {

// Blocks SIGINT, SIGTERM and SIGHUP until they are polled. Call once, before any thread starts: threads inherit it.
void HoldInterrupts();
// Whether one of them is pending.
bool InterruptPending();

class Progress {
 public:
  // `done` of the total were done earlier; a total of 0 is unknown, and the one of a video file may be too small.
  Progress(std::string what, std::int64_t total, std::int64_t done = 0, std::string unit = "frames");
  ~Progress();  // ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Advances by `count`, at least one. Throws Interrupted after Ctrl-C or another termination signal, but not where the
  // total is unknown: there the signal is the normal end of the work, and the caller calls InterruptPending.
  void Step(std::int64_t count = 1);

 private:
  void Draw() const;

  std::string what_, unit_;
  std::int64_t total_;
  std::int64_t before_;
  std::int64_t done_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

// "1:05", "2:03:04": minutes and seconds, with hours where there are any.
std::string Duration(double seconds);

}  // namespace vobench
