#include "tools/base/settings/problem.h"

#include <utility>

namespace settings {

std::string ToString(const Problem& problem) {
  std::string place = problem.file;
  if (problem.line > 0) place += ":" + std::to_string(problem.line) + ":" + std::to_string(problem.column);
  return place + ": " + problem.message;
}

std::string Joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + ToString(problem);
  return text;
}

Error::Error(std::vector<Problem> problems) : std::runtime_error(Joined(problems)), problems_(std::move(problems)) {}

}  // namespace settings
