// Provenance of a result: when it began, how long it took, and which versions made it.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace vobench {

// Time since it was made, and when that was.
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
