// Purpose: collects what is wrong with a struct of settings: one sentence per value, with its name and the rule.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace settings {

class Require {
 public:
  // Adds "name = value rule" unless `ok`; a value that is not finite is never well.
  void operator()(bool ok, const char* name, double value, const char* rule) {
    if (ok && std::isfinite(value)) return;
    std::ostringstream text;
    text << name << " = " << value << " " << rule;
    problems.push_back(text.str());
  }
  std::vector<std::string> problems;
};

}  // namespace settings
