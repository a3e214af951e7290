#include "tools/bench/result/ranks.h"

#include <algorithm>
#include <utility>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {

namespace ev = evaluation;

std::vector<RankTable> RankTables(const std::string& system, const std::vector<std::size_t>& rank_frames,
                                  const ev::ConsistencyVerdict& verdict) {
  constexpr std::size_t kDimensions = 12;
  constexpr double kTail = 0.025;  // of a consistent bar, on either side of its band
  std::vector<RankTable> tables;
  for (std::size_t i = 0; i < verdict.rank_histograms.size(); ++i) {
    const ev::RankHistogram& histogram = verdict.rank_histograms[i];
    if (histogram.runs == 0) continue;
    const std::size_t dimension = i % kDimensions;
    RankTable& table = tables.emplace_back();
    table.system = system;
    table.frame = rank_frames.at(i / kDimensions);
    table.dimension = std::string(ev::kStateBlocks[dimension / 3].name) + " " + "xyz"[dimension % 3];
    table.p_value = histogram.p_value;
    for (std::size_t bar = 0; bar < histogram.counts.size(); ++bar) {
      const double share = histogram.shares[bar];
      const auto runs = static_cast<std::size_t>(histogram.runs);
      table.counts.push_back(histogram.counts[bar]);
      table.low.push_back(static_cast<double>(runs - ev::BinomialLimit(runs, 1 - share, kTail)));
      table.high.push_back(static_cast<double>(ev::BinomialLimit(runs, share, kTail)));
    }
  }
  return tables;
}

void WriteRanks(const std::filesystem::path& out, const std::vector<RankTable>& tables) {
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
  base::WriteFile(out / "ranks.csv", text);
}

std::vector<RankTable> ReadRanks(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "ranks.csv";
  if (!std::filesystem::exists(file)) return {};
  ev::Problems problems;
  std::vector<RankTable> tables;
  bool header = true;
  for (const ev::Line& line : ev::Lines(file, ',')) {
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

}  // namespace vobench
