// Purpose: verdict.csv of a result folder: is a system consistent with its own model, check by check?
// Source:  docs/metrics.md, "Consistency as pass or fail".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace report {

struct VerdictRow {
  std::string system, check;
  double value = 0;
  std::string relation;  // ">=" or "<="
  double threshold = 0;
  bool pass = false;
  double false_alarm = 0;  // of an honest filter; 0: none can be stated
};

// None where there is no such file. Throws evaluation::InputError with every problem of it.
std::vector<VerdictRow> ReadVerdict(const std::filesystem::path& out);

// HTML; empty for no rows.
std::string VerdictTable(const std::vector<VerdictRow>& rows);

}  // namespace report
