#include "tools/report/verdict_table.h"

#include <fstream>
#include <regex>

#include "tools/evaluation/text_file.h"
#include "tools/report/html.h"
#include "tools/report/text.h"

namespace report {

namespace ev = evaluation;

std::vector<VerdictRow> ReadVerdict(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "verdict.csv";
  if (!std::filesystem::exists(file)) return {};
  std::ifstream stream(file);
  if (!stream) throw ev::InputError({file.string() + ": cannot be opened"});
  // Names of checks have commas and stand in quotes.
  static const std::regex form(R"re(([^,"]*),"([^"]*)",([^,]+),(>=|<=),([^,]+),(pass|fail),([^,]+))re");
  ev::Problems problems;
  std::vector<VerdictRow> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1) continue;  // the header
    std::smatch part;
    if (!std::regex_match(line, part, form)) {
      problems.Add(file, number, 1, "not system,\"check\",value,relation,threshold,pass,false_alarm");
      continue;
    }
    const auto value = [&](std::size_t k) {
      const std::string text = part[k];
      const auto parsed = ev::ParseNumber(text);
      const int column = static_cast<int>(part.position(k)) + 1;
      if (!parsed) problems.Add(file, number, column, "'" + text + "' is not a finite number");
      return parsed.value_or(0);
    };
    rows.push_back({part[1], part[2], value(3), part[4], value(5), part[6] == "pass", value(7)});
  }
  problems.ThrowIfAny();
  return rows;
}

std::string VerdictTable(const std::vector<VerdictRow>& rows) {
  if (rows.empty()) return "";
  std::vector<std::vector<std::string>> cells = {{"system", "check", "value", "passes", "verdict", "false alarm"}};
  for (const VerdictRow& row : rows) {
    cells.push_back({Escape(DisplayName(row.system)), Escape(row.check), Readable(row.value),
                     Escape(row.relation + " " + Readable(row.threshold)), row.pass ? "pass" : "<b>FAIL</b>",
                     row.false_alarm > 0 ? Percent(row.false_alarm, 0) : "–"});
  }
  return Table("Each check, with the rate at which an honest filter would fail it.", cells);
}

}  // namespace report
