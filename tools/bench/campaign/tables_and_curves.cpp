// Tables and curves of a campaign.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <set>

#include "tools/bench/campaign/campaign_file.h"
#include "tools/bench/campaign/results.h"

namespace vobench::campaign {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;
using Names = std::vector<std::string>;

bool CheckMetric(Section& section, const char* key, const std::string& metric) {
  const bool known = std::ranges::count(MetricNames(), metric) > 0;
  if (!known) {
    section.Reject(key, fmt::format("there is no metric '{}'; there are {}", metric, fmt::join(MetricNames(), ", ")));
  }
  return known;
}

// `used`: names used elsewhere in the same table or curve.
void CheckNames(Section& section, const char* key, const Names& names, const Names& known,
                std::set<std::string>& used) {
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) == 0) {
      section.Reject(key, fmt::format("'{}': there is no '{}'; there are {}", key, name, fmt::join(known, ", ")));
    }
    if (!used.insert(name).second) section.Reject(key, fmt::format("'{}': '{}' is there twice", key, name));
  }
}

Names LevelNames(const Campaign& campaign, const std::string& name) {
  Names names;
  if (name == "scenario") {
    for (const ScenarioEntry& scenario : campaign.scenarios) names.push_back(scenario.name);
  } else if (name == "system") {
    for (const SystemEntry& system : campaign.systems) names.push_back(Label(system.external, system.name));
  }
  for (const Factor& factor : campaign.factors) {
    if (factor.name != name) continue;
    for (const Level& level : factor.levels) names.push_back(level.name);
  }
  return names;
}

void ReadBeside(Section& table, const Campaign& campaign, TableSpec& spec) {
  std::vector<Section> sections = table.List("beside");
  if (!sections.empty() && spec.rows.size() != 1) {
    return table.Reject("beside", "'beside' needs exactly one name in 'rows'");
  }
  for (Section& section : sections) {
    ReferenceColumn beside;
    Changes values;
    section.Require("name", beside.name);
    if (!section.ReadRaw("values", values)) section.RequirePresent("values");
    const Names levels = LevelNames(campaign, spec.rows.front());
    for (const auto& [level, value] : values) {
      const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
      beside.values[level] = quoted ? value.substr(1, value.size() - 2) : value;
      if (std::ranges::count(levels, level) > 0) continue;
      section.Reject("values", fmt::format("'values': there is no {} '{}'; there are {}", spec.rows.front(), level,
                                           fmt::join(levels, ", ")));
    }
    spec.beside.push_back(std::move(beside));
  }
}

// All levels as numbers of one kind, in SI; empty where they are not numbers.
std::vector<double> NumbersOf(const Factor& factor) {
  for (int unit = 0; unit <= static_cast<int>(Unit::angular_acceleration_density); ++unit) {
    std::vector<double> numbers;
    for (const Level& level : factor.levels) {
      std::string problem;
      double value = 0;
      if (settings::ParseQuantity(level.name, static_cast<Unit>(unit), {}, value, problem)) numbers.push_back(value);
    }
    if (numbers.size() == factor.levels.size()) return numbers;
  }
  return {};
}

bool InOrder(const std::vector<double>& doses) {
  return std::ranges::adjacent_find(doses, std::greater_equal()) == doses.end() ||  // rises
         std::ranges::adjacent_find(doses, std::less_equal()) == doses.end();
}

// The unit in which the last level (the first may be 0) is written.
void ReadUnit(const Factor& factor, CurveSpec& curve) {
  const std::string& text = factor.levels.back().name;
  const std::size_t space = text.find(' ');
  double number = 0;
  std::string problem;
  if (space == std::string::npos || !settings::ParseQuantity(text.substr(0, space), Unit::none, {}, number, problem) ||
      number == 0) {
    return;
  }
  curve.unit = text.substr(space + 1);
  curve.unit_in_si = curve.doses.back() / number;
}

void ReadDoses(Section& section, const Campaign& campaign, CurveSpec& curve) {
  const auto factor = std::ranges::find(campaign.factors, curve.along, &Factor::name);
  if (factor == campaign.factors.end()) {
    Names names;
    for (const Factor& f : campaign.factors) names.push_back(f.name);
    section.Reject("along", fmt::format("'along': nothing that is varied is called '{}'; there are: {}", curve.along,
                                        fmt::join(names, ", ")));
    return;
  }
  curve.doses = NumbersOf(*factor);
  if (curve.doses.size() < 2) {
    section.Reject("along",
                   fmt::format("'along': the values of '{}' are not two or more numbers of one kind", curve.along));
  } else if (!InOrder(curve.doses)) {
    section.Reject("along", fmt::format("'along': the values of '{}' neither rise nor fall: they are in the order of "
                                        "stress, the mildest first",
                                        curve.along));
  } else {
    ReadUnit(*factor, curve);
  }
}

// "ATE [m]"; without a unit that is 1.
std::string DefaultTitle(const std::string& metric, double unit_in_si) {
  const std::string si = UnitOf(metric);
  if (si == "1") return metric;
  const char* unit = unit_in_si == 1 ? si.c_str() : unit_in_si == 1e-2 ? "cm" : unit_in_si == 1e-3 ? "mm" : "deg";
  return (metric == "ate_m" ? "ATE" : metric.substr(0, metric.size() - si.size() - 1)) + " [" + unit + "]";
}

}  // namespace

std::vector<TableSpec> ReadTables(Section root, const Campaign& campaign) {
  const Names factors = VariedNames(campaign);
  Names known = factors;
  known.insert(known.begin(), "system");
  std::vector<TableSpec> tables;
  for (Section& section : root.List("tables", "metric")) {
    TableSpec& table = tables.emplace_back(TableSpec{"ate_m", "", factors, {"system"}});
    section.Require("metric", table.metric);
    section.Read("rows", table.rows);
    section.Read("columns", table.columns);
    const bool is_metric = CheckMetric(section, "metric", table.metric);
    std::set<std::string> used;
    CheckNames(section, "rows", table.rows, known, used);
    CheckNames(section, "columns", table.columns, known, used);
    constexpr double kDegree = std::numbers::pi / 180;
    section.ReadChoice("unit", table.unit_in_si, {{"SI", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"deg", kDegree}});
    const std::string fits = table.unit_in_si == 1 ? "" : table.unit_in_si == kDegree ? "rad" : "m";
    if (is_metric && !fits.empty() && UnitOf(table.metric) != fits) {
      section.Reject("unit", fmt::format("'{}' is in {}, not in {}", table.metric, UnitOf(table.metric), fits));
    }
    ReadBeside(section, campaign, table);
    table.title = DefaultTitle(table.metric, table.unit_in_si);
    section.Read("title", table.title);
  }
  if (tables.empty()) tables.push_back({"ate_m", DefaultTitle("ate_m", 1), factors, {"system"}});
  return tables;
}

std::vector<CurveSpec> ReadCurves(Section root, const Campaign& campaign) {
  std::vector<CurveSpec> curves;
  for (Section& section : root.List("curves")) {
    CurveSpec& curve = curves.emplace_back();
    if (section.Require("along", curve.along)) ReadDoses(section, campaign, curve);
    section.Require("of", curve.metrics);
    if (section.Has("of") && curve.metrics.empty()) section.Reject("of", "'of': at least one metric is needed");
    std::set<std::string> used;
    for (const std::string& metric : curve.metrics) {
      CheckMetric(section, "of", metric);
      if (!used.insert(metric).second) section.Reject("of", fmt::format("'of': '{}' is there twice", metric));
    }
    Names others = VariedNames(campaign);
    others.erase(std::remove(others.begin() + 1, others.end(), curve.along), others.end());
    curve.by = others;
    section.Read("by", curve.by);
    CheckNames(section, "by", curve.by, others, used);
    section.Child("break_at").Read("error", curve.break_error_m, Unit::length, Range::AtLeast(0));
  }
  return curves;
}

}  // namespace vobench::campaign
