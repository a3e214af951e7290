#include "tools/bench/report/rank_table.h"

#include <algorithm>
#include <utility>

#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace report {

namespace ev = evaluation;

std::string RanksCsv(const std::vector<RankTable>& tables) {
  std::string text = "system,frame,dimension,bar,count,low,high,p_value\n";
  for (const RankTable& table : tables) {
    const std::string start = table.system + "," + std::to_string(table.frame) + "," + table.dimension + ",";
    for (std::size_t bar = 0; bar < table.counts.size(); ++bar) {
      text += start + std::to_string(bar + 1);
      for (const double value : {table.counts[bar], table.low[bar], table.high[bar], table.p_value}) {
        text += "," + base::Significant(value, 6);
      }
      text += "\n";
    }
  }
  return text;
}

std::vector<RankTable> ReadRanks(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "ranks.csv";
  if (!std::filesystem::exists(file)) return {};
  ev::Problems problems;
  std::vector<RankTable> tables;
  bool header = true;
  for (const ev::Line& line : ev::ReadLines(file, ',')) {
    if (std::exchange(header, false)) continue;
    if (line.tokens.size() != 8) {
      problems.Add(file, line.number, 1, std::to_string(line.tokens.size()) + " columns where 8 are expected");
      continue;
    }
    const auto number = [&](std::size_t column) {
      const ev::Token& token = line.tokens[column];
      const auto value = ev::ParseNumber(token.text);
      if (!value) problems.Add(file, line.number, token.column, "'" + token.text + "' is not a finite number");
      return value.value_or(0);
    };
    const double frame = number(1);
    if (!(frame >= 0 && frame < 1e9)) problems.Add(file, line.number, line.tokens[1].column, "no frame's number");
    const std::string &system = line.tokens[0].text, &dimension = line.tokens[2].text;
    if (number(3) == 1)
      tables.push_back(
          {system, static_cast<std::size_t>(std::clamp(frame, 0.0, 1e9)), dimension, number(7), {}, {}, {}});
    if (tables.empty() || tables.back().system != system || tables.back().dimension != dimension) {
      problems.Add(file, line.number, 1, "bars of a histogram must follow each other, from 1");
      continue;
    }
    tables.back().counts.push_back(number(4));
    tables.back().low.push_back(number(5));
    tables.back().high.push_back(number(6));
  }
  problems.ThrowIfAny();
  return tables;
}

}  // namespace report
