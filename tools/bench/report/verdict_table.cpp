#include "tools/bench/report/verdict_table.h"

#include <fstream>

#include "tools/bench/report/html.h"
#include "tools/bench/report/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace report {

namespace ev = evaluation;

namespace {

// Names of checks have commas and stand in quotes. Empty where none does.
std::vector<ev::Token> Fields(const std::string& line) {
  const std::size_t open = line.find(",\""), close = open == std::string::npos ? open : line.find("\",", open + 2);
  if (close == std::string::npos) return {};
  std::vector<ev::Token> fields;
  const auto add = [&](std::size_t begin, std::size_t end) {
    fields.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
  };
  add(0, open);
  add(open + 2, close);
  std::size_t begin = close + 2;
  for (std::size_t comma; (comma = line.find(',', begin)) != std::string::npos; begin = comma + 1) add(begin, comma);
  add(begin, line.size());
  return fields;
}

bool IsRow(const std::vector<ev::Token>& fields) {
  return fields.size() == 7 && fields[0].text.find_first_of(",\"") == std::string::npos &&
         fields[1].text.find('"') == std::string::npos && (fields[3].text == ">=" || fields[3].text == "<=") &&
         (fields[5].text == "pass" || fields[5].text == "fail");
}

}  // namespace

std::vector<VerdictRow> ReadVerdict(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "verdict.csv";
  if (!std::filesystem::exists(file)) return {};
  std::ifstream stream(file);
  if (!stream) throw ev::InputError({file.string() + ": cannot be opened"});
  ev::Problems problems;
  std::vector<VerdictRow> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1) continue;  // the header
    const std::vector<ev::Token> fields = Fields(line);
    if (!IsRow(fields)) {
      problems.Add(file, number, 1, "not system,\"check\",value,relation,threshold,pass,false_alarm");
      continue;
    }
    const auto value = [&](std::size_t k) {
      const auto parsed = ev::ParseNumber(fields[k].text);
      if (!parsed) problems.Add(file, number, fields[k].column, "'" + fields[k].text + "' is not a finite number");
      return parsed.value_or(0);
    };
    rows.push_back(
        {fields[0].text, fields[1].text, value(2), fields[3].text, value(4), fields[5].text == "pass", value(6)});
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
