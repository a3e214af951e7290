#include "tools/bench/result/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "tools/base/files.h"
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

std::string VerdictSentence(const SystemVerdict& v) {
  const std::string name = DisplayName(v.system);
  std::vector<std::string> failed;
  for (const ev::Check& check : v.verdict.checks) {
    if (!check.pass && !check.name.starts_with("RMSE / bound")) failed.push_back(check.name);
  }
  if (failed.empty()) return fmt::format("{} is consistent with its own model at {}.", name, v.setting);
  const auto join = [](const std::vector<std::string>& texts) {
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(texts.size(), 3); ++i) all += (i == 0 ? "" : ", ") + texts[i];
    if (texts.size() > 3) all += fmt::format(" and {} more", texts.size() - 3);
    return all;
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
      100 * verdict.energy[0], 180 / M_PI * verdict.energy[1], 100 * verdict.energy[2], 180 / M_PI * verdict.energy[3],
      verdict.effective_components);
  text += fmt::format("A consistent filter fails one of these checks in at most {:.0f} % of such tables.\n",
                      100 * verdict.false_alarm());
  return text + VerdictSentence(v) + "\n";
}

std::vector<VerdictRow> VerdictRows(const SystemVerdict& v) {
  std::vector<VerdictRow> rows;
  for (const ev::Check& check : v.verdict.checks) rows.push_back({v.system, check});
  return rows;
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
    const auto value = [&](std::size_t k) {
      const auto parsed = ev::ParseNumber(fields[k].text);
      if (!parsed) problems.Add(file, number, fields[k].column, "'" + fields[k].text + "' is not a finite number");
      return parsed.value_or(0);
    };
    rows.push_back({fields[0].text,
                    {fields[1].text, value(2), value(4), fields[3].text == ">=", fields[5].text == "pass", value(6)}});
  }
  problems.ThrowIfAny();
  return rows;
}

}  // namespace vobench
