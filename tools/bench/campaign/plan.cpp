#include "tools/bench/campaign/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace vobench::campaign {

evaluation::Alignment AlignmentOf(const Campaign& campaign, const SystemEntry& system) {
  const bool own = campaign.align == evaluation::Alignment::sim3 && system.external.sensors.metric();
  return own ? system.external.align : campaign.align;
}

std::vector<evaluation::Alignment> AlignmentsOf(const Campaign& campaign) {
  std::vector<evaluation::Alignment> all;
  for (const SystemEntry& system : campaign.systems) {
    const evaluation::Alignment one = AlignmentOf(campaign, system);
    if (std::ranges::count(all, one) == 0) all.push_back(one);
  }
  return all;
}

std::size_t Points(const Campaign& campaign) {
  std::size_t points = campaign.scenarios.size();
  for (const Factor& factor : campaign.factors) points *= factor.levels.size();
  return points;
}

std::int64_t Tasks(const Campaign& campaign) {
  return static_cast<std::int64_t>(Points(campaign) * campaign.systems.size() * campaign.seeds.size());
}

TaskChoice ChoiceOf(const Campaign& campaign, std::int64_t task) {
  if (task < 0 || task >= Tasks(campaign)) {
    throw std::out_of_range(fmt::format("there is no task {}: there are 0 to {}", task, Tasks(campaign) - 1));
  }
  TaskChoice choice;
  std::size_t rest = static_cast<std::size_t>(task);
  const auto digit = [&rest](std::size_t base) {
    const std::size_t value = rest % base;
    rest /= base;
    return value;
  };
  choice.system = digit(campaign.systems.size());
  choice.point = rest % Points(campaign);
  choice.levels.resize(campaign.factors.size());
  for (std::size_t i = campaign.factors.size(); i-- > 0;) choice.levels[i] = digit(campaign.factors[i].levels.size());
  choice.scenario = digit(campaign.scenarios.size());
  choice.seed = rest;
  return choice;
}

Changes ChangesAt(const Campaign& campaign, const TaskChoice& choice) {
  const ScenarioEntry& scenario = campaign.scenarios[choice.scenario];
  const SystemEntry& system = campaign.systems[choice.system];
  Changes all = scenario.set;
  const auto add = [&all](const Changes& more) { all.insert(all.end(), more.begin(), more.end()); };
  for (std::size_t i = 0; i < campaign.factors.size(); ++i) add(campaign.factors[i].levels[choice.levels[i]].set);
  add(system.set);
  const auto special = scenario.for_system.find(system.name);
  if (special != scenario.for_system.end()) add(special->second);
  return all;
}

std::vector<std::string> VariedNames(const Campaign& campaign) {
  std::vector<std::string> names = {"scenario"};
  for (const Factor& factor : campaign.factors) names.push_back(factor.name);
  return names;
}

std::vector<std::string> LevelsOf(const Campaign& campaign, const std::vector<std::string>& names,
                                  const TaskChoice& choice) {
  std::vector<std::string> levels;
  for (const std::string& name : names) {
    if (name == "scenario") levels.push_back(campaign.scenarios[choice.scenario].name);
    if (name == "system") {
      const SystemEntry& system = campaign.systems[choice.system];
      levels.push_back(Label(system.external, system.name));
    }
    for (std::size_t i = 0; i < campaign.factors.size(); ++i) {
      if (campaign.factors[i].name == name) levels.push_back(campaign.factors[i].levels[choice.levels[i]].name);
    }
  }
  return levels;
}

std::string Describe(const Campaign& campaign, const TaskChoice& choice) {
  std::string text = campaign.scenarios[choice.scenario].name;
  for (std::size_t i = 0; i < campaign.factors.size(); ++i) {
    text += fmt::format(", {} {}", campaign.factors[i].name, campaign.factors[i].levels[choice.levels[i]].name);
  }
  return text + fmt::format(", {}, seed {}", campaign.systems[choice.system].name, campaign.seeds[choice.seed]);
}

}  // namespace vobench::campaign
