#include "tools/bench/campaign/table_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "tools/bench/campaign/results.h"

namespace vobench::campaign {
namespace {

using settings::Section;

bool Contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

void CheckSides(Section& section, const TableSpec& table, const std::vector<std::string>& factors) {
  std::set<std::string> used;
  for (const char* side : {"rows", "columns"}) {
    for (const std::string& name : side == std::string("rows") ? table.rows : table.columns) {
      if (name != "system" && !Contains(factors, name)) {
        section.Reject(
            side, fmt::format("'{}': there is no '{}'; there are system, {}", side, name, fmt::join(factors, ", ")));
      }
      if (!used.insert(name).second) section.Reject(side, fmt::format("'{}': '{}' is there twice", side, name));
    }
  }
}

std::vector<std::string> LevelNames(const Campaign& campaign, const std::string& name) {
  std::vector<std::string> names;
  if (name == "scenario") {
    for (const ScenarioEntry& scenario : campaign.scenarios) names.push_back(scenario.name);
  } else if (name == "system") {
    for (const SystemEntry& system : campaign.systems) names.push_back(system.name);
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
    const std::vector<std::string> levels = LevelNames(campaign, spec.rows.front());
    for (const auto& [level, value] : values) {
      const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
      beside.values[level] = quoted ? value.substr(1, value.size() - 2) : value;
      if (Contains(levels, level)) continue;
      section.Reject("values", fmt::format("'values': there is no {} '{}'; there are {}", spec.rows.front(), level,
                                           fmt::join(levels, ", ")));
    }
    spec.beside.push_back(std::move(beside));
  }
}

}  // namespace

std::vector<TableSpec> ReadTables(Section root, const Campaign& campaign, const std::vector<std::string>& metrics) {
  std::vector<std::string> factors = {"scenario"};
  for (const Factor& factor : campaign.factors) factors.push_back(factor.name);
  std::vector<TableSpec> tables;
  std::vector<Section> sections = root.List("tables", "metric");
  for (Section& section : sections) {
    TableSpec table{"ate_m", "", factors, {"system"}};
    section.Require("metric", table.metric);
    section.Read("rows", table.rows);
    section.Read("columns", table.columns);
    const bool known = Contains(metrics, table.metric);
    if (!known) {
      section.Reject("metric",
                     fmt::format("there is no metric '{}'; there are {}", table.metric, fmt::join(metrics, ", ")));
    }
    CheckSides(section, table, factors);
    constexpr double kDegree = std::numbers::pi / 180;
    section.ReadChoice("unit", table.unit_in_si, {{"SI", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"deg", kDegree}});
    const std::string fits = table.unit_in_si == 1 ? "" : table.unit_in_si == kDegree ? "rad" : "m";
    if (known && !fits.empty() && UnitOf(table.metric) != fits) {
      section.Reject("unit", fmt::format("'{}' is in {}, not in {}", table.metric, UnitOf(table.metric), fits));
    }
    ReadBeside(section, campaign, table);
    table.title = table.metric;
    section.Read("title", table.title);
    tables.push_back(std::move(table));
  }
  if (sections.empty()) tables.push_back({"ate_m", "ate_m", factors, {"system"}});
  return tables;
}

}  // namespace vobench::campaign
