// State of a document while it is read. Private to tools/base/settings.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "tools/base/settings/element.h"
#include "tools/base/settings/request.h"

namespace settings {

struct State {
  Element root;
  Request requests;
  bool reading = false;
  std::vector<Problem> problems;
  std::deque<Element> made;  // sections that the file writes as a single word

  void AddProblem(const Place& place, std::string message) {
    problems.push_back({place.file, place.line, place.column, std::move(message), place.key});
  }
};

}  // namespace settings
