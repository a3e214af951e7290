// Long work: progress on stderr, a bar with the remaining time on a terminal and plain lines otherwise; and Ctrl-C,
// noticed between two steps, so that destructors run and nothing half-written stays.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace vobench {

// From now on SIGINT, SIGTERM and SIGHUP wait to be asked for. Call once, before any thread starts: threads inherit it.
void HoldInterrupts();
// Whether one of them waits.
bool InterruptPending();

class Progress {
 public:
  // `done` of the total were done before; a total of 0 is not known, and one that a video file says may be too small.
  Progress(std::string what, std::int64_t total, std::int64_t done = 0, std::string unit = "frames");
  ~Progress();  // ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // So many more of the total are done, at least one. Throws Interrupted when Ctrl-C or a request to end has arrived,
  // but not where the total is unknown: there that is how the work ends, and the caller calls InterruptPending.
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
