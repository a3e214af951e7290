#include "tools/bench/result/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace {

namespace ev = evaluation;

const char* Relation(const ev::Check& check) { return check.at_least ? ">=" : "<="; }

// "ANEES of position 2.4 (an exact filter's: 0.86 to 1.16)", worst first.
std::vector<std::string> OutOfBand(const ev::ConsistencyVerdict& verdict, bool above) {
  std::vector<std::pair<double, std::string>> found;
  for (std::size_t b = 0; b < verdict.anees.size(); ++b) {
    const ev::AneesVerdict& anees = verdict.anees[b];
    const double mean = anees.measured.mean;
    if (above ? mean <= anees.mean_high : mean >= anees.mean_low) continue;
    found.emplace_back(above ? -mean : mean,
                       fmt::format("ANEES of {} {} (an exact filter's: {:.2f} to {:.2f})", ev::kStateBlocks[b].name,
                                   Readable(mean), anees.mean_low, anees.mean_high));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> texts;
  for (auto& [key, text] : found) texts.push_back(std::move(text));
  return texts;
}

// Fields of a line; names of checks contain commas and are quoted. Empty for an invalid line.
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

std::string VerdictSentence(const SystemVerdict& v) {
  const std::string name = DisplayName(v.system);
  std::vector<std::string> failed;
  for (const ev::Check& check : v.verdict.checks) {
    if (!check.pass && !check.name.starts_with("RMSE / bound")) failed.push_back(check.name);
  }
  if (failed.empty()) return fmt::format("{} is consistent with its own model at {}.", name, v.setting);
  const auto join = [](const std::vector<std::string>& texts) {
    const std::size_t shown = std::min<std::size_t>(texts.size(), 3), more = texts.size() - shown;
    return fmt::format("{}{}", fmt::join(texts.begin(), texts.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
  };
  const auto above = OutOfBand(v.verdict, true), below = OutOfBand(v.verdict, false);
  if (!above.empty() && below.empty())
    return fmt::format("{} is over-confident at {}: {}.", name, v.setting, join(above));
  if (above.empty() && !below.empty())
    return fmt::format("{} is under-confident (conservative) at {}: {}.", name, v.setting, join(below));
  return fmt::format("{} is not consistent with its own model at {}: {} failed.", name, v.setting, join(failed));
}

std::string VerdictText(const SystemVerdict& v) {
  const ev::ConsistencyVerdict& verdict = v.verdict;
  std::string text = fmt::format("\n{} at {}: consistency over {} runs of {} frames\n", DisplayName(v.system),
                                 v.setting, v.runs, v.frames);
  text += fmt::format("{:<34}{:>10}{:>14}  {:<6}{:>12}\n", "check", "value", "threshold", "", "false alarm");
  for (const ev::Check& check : verdict.checks) {
    text += fmt::format("{:<34}{:>10}{:>14}  {:<6}{:>12}\n", check.name, Readable(check.value),
                        fmt::format("{} {}", Relation(check), Readable(check.threshold)), check.pass ? "pass" : "FAIL",
                        check.false_alarm > 0 ? fmt::format("{:.0f} %", 100 * check.false_alarm) : "-");
  }
  if (verdict.nis_mean) {
    text += fmt::format("NIS / dof {:.4f} +- {:.4f} over {} runs", verdict.nis_mean->per_dof,
                        verdict.nis_mean->standard_error, verdict.nis_mean->runs);
  }
  if (verdict.whiteness && !verdict.whiteness->mean_autocorrelation.empty()) {
    text += fmt::format("; its autocorrelation at one frame {:+.3f}", verdict.whiteness->mean_autocorrelation.front());
  }
  text += fmt::format(
      "\nEnergy score [cm, deg, cm/s, deg/s]: {:.3f}, {:.4f}, {:.3f}, {:.3f}; effective components {:.1f}\n",
      100 * verdict.energy[0], kDegrees * verdict.energy[1], 100 * verdict.energy[2], kDegrees * verdict.energy[3],
      verdict.effective_components);
  text += fmt::format("A consistent filter fails one of these checks in at most {:.0f} % of such tables.\n",
                      100 * verdict.false_alarm());
  return text + VerdictSentence(v) + "\n";
}

void WriteVerdict(const std::filesystem::path& out, const std::vector<VerdictRow>& rows) {
  std::string text = "system,check,value,relation,threshold,pass,false_alarm\n";
  for (const auto& [system, check] : rows) {
    text += fmt::format("{},\"{}\",{:.6g},{},{:.6g},{},{:.6g}\n", system, check.name, check.value, Relation(check),
                        check.threshold, check.pass ? "pass" : "fail", check.false_alarm);
  }
  base::WriteFile(out / "verdict.csv", text);
}

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
    const auto value = [&](std::size_t k) { return ev::NumberIn(file, number, fields[k], problems); };
    rows.push_back({fields[0].text,
                    {fields[1].text, value(2), value(4), fields[3].text == ">=", fields[5].text == "pass", value(6)}});
  }
  problems.ThrowIfAny();
  return rows;
}

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
    if (!ev::HasColumns(file, line, 8, problems)) continue;
    const auto number = [&](std::size_t k) { return ev::NumberIn(file, line.number, line.tokens[k], problems); };
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
