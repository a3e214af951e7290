#include "tools/base/settings/problem.h"

#include <utility>

namespace settings {
namespace {

std::string Join(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + ToString(problem);
  return text;
}

}  // namespace

std::string ToString(const Problem& problem) {
  std::string place = problem.file;
  if (problem.line > 0) place += ":" + std::to_string(problem.line) + ":" + std::to_string(problem.column);
  return place + ": " + problem.message;
}

Error::Error(std::vector<Problem> problems) : std::runtime_error(Join(problems)), problems_(std::move(problems)) {}

}  // namespace settings
