// Problems of a settings file: all at once, each with its place.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace settings {

struct Problem {
  std::string file;  // or "--set a.b.c" for a value from the command line
  int line = 0;      // 1-based; 0: the whole file
  int column = 0;    // 1-based, in bytes
  std::string message;
  std::string key = {};  // of a value from the command line: its dotted key
};

// "file:line:column: message", or "file: message" without a line.
std::string ToString(const Problem& problem);

// All of them, one a line.
std::string Joined(const std::vector<Problem>& problems);

// what(): all problems, one per line, in the order of the file.
class Error : public std::runtime_error {
 public:
  explicit Error(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace settings
