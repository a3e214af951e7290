// Provenance of a result: start time, duration, and versions of the software.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace vobench {

// Time since construction, and the time of construction.
class Clock {
 public:
  double seconds() const;
  std::string started_utc() const;  // ISO 8601

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::system_clock::time_point wall_ = std::chrono::system_clock::now();
};

// Program, compiler and libraries, by name.
std::map<std::string, std::string> Versions();

}  // namespace vobench
