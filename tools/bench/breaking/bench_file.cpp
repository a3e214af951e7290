#include "tools/bench/breaking/bench_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "tools/base/settings/settings.h"
#include "tools/base/text.h"
#include "tools/bench/text.h"

namespace vobench::breaking {
namespace fs = std::filesystem;
namespace {

using campaign::Changes;
using settings::Range;
using settings::Section;

std::string Number(double x) { return fmt::format("{:.7g}", x); }

// "A op x" or "x"; none where it is neither.
std::optional<double> Evaluate(const std::string& text, double x) {
  const std::vector<base::Word> words = base::SplitWords(text);
  if (words.size() == 1 && words[0].text == "x") return x;
  const auto a = words.empty() ? std::nullopt : base::ParseNumber(words[0].text);
  if (!a || words.size() != 3 || words[1].text.size() != 1 || words[2].text != "x") return std::nullopt;
  switch (words[1].text.front()) {
    case '+':
      return *a + x;
    case '-':
      return *a - x;
    case '*':
      return *a * x;
    case '/':
      return *a / x;
    default:
      return std::nullopt;
  }
}

// Replaces each "$x" and "$(...)" by the number; none where one of them is invalid, or there is none.
std::optional<std::string> Fill(const std::string& text, double x) {
  std::string filled;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find('$', from)) != std::string::npos;) {
    const bool long_one = text.compare(at, 2, "$(") == 0;
    const std::size_t end = long_one ? text.find(')', at) : at + 1;
    if (end >= text.size()) return std::nullopt;
    const auto value = Evaluate(long_one ? text.substr(at + 2, end - at - 2) : text.substr(at + 1, 1), x);
    if (!value) return std::nullopt;
    filled += text.substr(from, at - from) + Number(*value);
    from = end + 1;
  }
  if (from == 0) return std::nullopt;
  return filled + text.substr(from);
}

bool HasDose(const std::string& text) { return text.find('$') != std::string::npos; }

struct Base {
  fs::path file;
  Changes set;
};

Stress ReadStress(Section& section, const fs::path& folder, const Base& base, const Changes& mode) {
  Stress stress;
  std::string file;
  section.Require("name", stress.name);
  section.Read("unit", stress.unit);
  stress.file = section.Read("scenario", file) ? folder / file : base.file;
  stress.base = base.set;
  stress.base.insert(stress.base.end(), mode.begin(), mode.end());
  section.Require("mild", stress.mild);
  section.Require("severe", stress.severe);
  section.ReadChoice("scale", stress.logarithmic, {{"linear", false}, {"log", true}});
  section.Read("limit", stress.limit);
  section.ReadRaw("set", stress.set);
  if (stress.mild == stress.severe) section.Reject("severe", "'severe' is as mild as 'mild'");
  if (stress.logarithmic && !(stress.mild > 0 && stress.severe > 0)) {
    section.Reject("scale", "'scale: log': 'mild' and 'severe' must be above 0");
  }
  bool any = false;
  for (const auto& [key, value] : stress.set) {
    if (!HasDose(value)) continue;
    any = true;
    if (!Fill(value, stress.mild)) {
      section.Reject("set", fmt::format("'{}': '{}': the dose is $x or $(A op x), op one of + - * /", key, value));
    }
  }
  if (!any) section.Reject("set", "'set': nothing depends on the dose, $x");
  return stress;
}

void RequireDistinct(Section root, const std::string& key, const std::vector<Stress>& stresses) {
  std::set<std::string> names;
  for (const Stress& stress : stresses) {
    if (!names.insert(stress.name).second) root.Reject(key, fmt::format("'{}' is there twice", stress.name));
  }
}

}  // namespace

double Scale::At(double share) const {
  return logarithmic ? mild * std::pow(severe / mild, share) : mild + share * (severe - mild);
}

Changes Stress::SettingsAt(double value) const {
  Changes all;
  for (const auto& [key, text] : set) all.emplace_back(key, HasDose(text) ? Fill(text, value).value() : text);
  return all;
}

std::string Scale::Text(double value) const { return Readable(value) + (unit.empty() ? "" : " " + unit); }

BenchFile ReadBenchFile(const fs::path& path, const std::string& mode) {
  settings::Document document = settings::Document::FromFile(path);
  Section root = document.root();
  const fs::path folder = path.parent_path();
  BenchFile bench;
  bench.file = path;
  std::string text;
  if (root.Read("external", text)) bench.external = folder / text;
  std::vector<std::string> references;
  root.Read("references", references);
  for (const std::string& reference : references) bench.references.push_back(folder / reference);
  Section broken = root.Child("broken");
  broken.Read("error_share_of_spread", bench.error_share_of_spread, Range::Positive());
  broken.Read("pose_coverage", bench.pose_coverage, Range{0, 1});
  Changes accuracy, set;
  for (const std::string name : {"quick", "full"}) {
    BenchFile other;
    Changes set_there, accuracy_there;
    Section section = root.Child(name);
    BenchFile& to = name == mode ? bench : other;
    section.Read("seeds", to.seeds, Range{1, 10000});
    section.Read("steps", to.steps, Range{2, 4096});
    section.Read("accuracy_seeds", to.accuracy_seeds, Range{1, 10000});
    section.ReadRaw("accuracy_set", name == mode ? accuracy : accuracy_there);
    section.ReadRaw("set", name == mode ? set : set_there);
  }
  Base base;
  Section base_section = root.Child("base");
  if (base_section.Read("scenario", text)) base.file = folder / text;
  base_section.ReadRaw("set", base.set);
  for (Section& section : root.List("accuracy", "file")) {
    AccuracyScenario& scenario = bench.accuracy.emplace_back();
    std::string file, needs;
    section.Require("file", file);
    scenario.file = folder / file;
    scenario.name = scenario.file.stem().string();
    section.Read("name", scenario.name);
    if (section.Read("needs", needs)) scenario.there = fs::exists(folder / needs);
    scenario.set = accuracy;
    Changes own;
    section.ReadRaw("set", own);
    scenario.set.insert(scenario.set.end(), own.begin(), own.end());
  }
  const auto read = [&](const std::string& key, std::vector<Section> sections, std::vector<Stress>& stresses) {
    for (Section& section : sections) {
      stresses.push_back(ReadStress(section, folder, base, set));
      if (stresses.back().file.empty()) section.Reject("name", "neither 'scenario' here nor 'base.scenario'");
    }
    RequireDistinct(root, key, stresses);
  };
  read("stresses", root.List("stresses"), bench.stresses);
  Section attack = root.Child("attack");
  attack.Read("seeds", bench.attack_seeds, Range{1, 1000});
  attack.Read("trials", bench.attack_trials, Range{1, 100000});
  read("attack", attack.List("parameters"), bench.attack);
  document.ThrowIfBad();
  return bench;
}

}  // namespace vobench::breaking
