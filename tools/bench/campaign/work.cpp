#include "tools/bench/campaign/work.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "tools/bench/campaign/campaign_file.h"
#include "tools/bench/campaign/digest.h"
#include "tools/bench/campaign/sequence.h"
#include "tools/bench/errors.h"
#include "tools/bench/result/interrupt.h"
#include "tools/bench/systems/systems.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

Experiment Load(const campaign::Campaign& campaign, const campaign::TaskChoice& choice) {
  const campaign::Changes changes = campaign::ChangesAt(campaign, choice);
  Experiment experiment = LoadExperiment(campaign.scenarios[choice.scenario].file, changes);
  const auto asks = [](const auto& change) { return change.first == "truth"; };
  if (experiment.scenario.points || std::any_of(changes.begin(), changes.end(), asks)) return experiment;
  // No truth beside poses and velocities unless the campaign asks for it: nobody here would look at it.
  experiment.scenario.truth.streams.clear();
  for (std::string* resolved : {&experiment.scenario.resolved, &experiment.resolved}) {
    auto json = nlohmann::ordered_json::parse(*resolved);
    json["truth"] = nlohmann::ordered_json::array();
    *resolved = json.dump(2);
  }
  return experiment;
}

// The value of a dotted key in SI, where there is such a number; or else as the campaign writes it.
std::string LevelValue(const nlohmann::json& resolved, const campaign::Factor& factor, std::size_t level) {
  const nlohmann::json* value = &resolved;
  for (std::size_t at = 0; !factor.key.empty() && at <= factor.key.size();) {
    const std::size_t dot = std::min(factor.key.find('.', at), factor.key.size());
    const std::string part = factor.key.substr(at, dot - at);
    if (!value->is_object() || !value->contains(part)) return factor.levels[level].name;
    value = &(*value)[part];
    at = dot + 1;
  }
  return !factor.key.empty() && value->is_number() ? value->dump() : factor.levels[level].name;
}

// Of pictures the key says which files they were made from.
std::string DigestOfSettings(const Experiment& experiment) {
  const sim::Scenario& scenario = experiment.scenario;
  return campaign::Digest(experiment.resolved + (scenario.points ? DigestOfPointFiles(scenario) : ""));
}

// A world of points has the seed of its task.
void RefuseSeed(campaign::CampaignFile& file, const campaign::TaskChoice& choice, const Experiment& experiment) {
  if (!experiment.scenario.points) return;
  for (const auto& [key, value] : campaign::ChangesAt(file.campaign(), choice)) {
    if (key == "seed") file.Reject(choice, "seed", "each task has a world of its own, with the seed of the task");
  }
  if (file.campaign().systems[choice.system].system.empty()) {
    file.Reject(choice, "",
                "a world of points has no pictures for '" + file.campaign().systems[choice.system].name + "'");
  }
}

// What would not reach it must not look as if it did.
void RefuseForExternal(campaign::CampaignFile& file, const campaign::TaskChoice& choice, const Experiment& experiment) {
  const campaign::SystemEntry& system = file.campaign().systems[choice.system];
  if (!system.system.empty() || experiment.prior.focal_error == 0) return;
  file.Reject(choice, "prior.focal_error", "'" + system.name + "' is not ours: it is told the camera as it is");
}

}  // namespace

campaign::TaskChoice AtPoint(const campaign::Campaign& campaign, std::size_t point, std::size_t system) {
  return campaign::ChoiceOf(campaign, static_cast<std::int64_t>(point * campaign.systems.size() + system));
}

CampaignWork::CampaignWork(const fs::path& file, fs::path cache)
    : cache_(std::move(cache)), program_(campaign::DigestOfProgram()) {
  Input([&] { Resolve(file); });
}

void CampaignWork::Resolve(const fs::path& path) {
  campaign::CampaignFile file(path, {SystemNames(), campaign::MetricNames()});
  campaign_ = file.campaign();
  const std::size_t points = file.complete() ? campaign::Points(campaign_) : 0;
  for (std::size_t p = 0; p < points; ++p) {
    CampaignPoint& point = points_.emplace_back();
    for (std::size_t s = 0; s < campaign_.systems.size(); ++s) {
      const campaign::TaskChoice choice = AtPoint(campaign_, p, s);
      try {
        const Experiment experiment = Load(campaign_, choice);
        RefuseSeed(file, choice, experiment);
        RefuseForExternal(file, choice, experiment);
        point.settings.push_back(DigestOfSettings(experiment));
        if (s > 0) continue;
        point.images = !experiment.scenario.points;
        const nlohmann::json resolved = nlohmann::json::parse(experiment.resolved);
        for (std::size_t i = 0; i < campaign_.factors.size(); ++i) {
          const campaign::Factor& factor = campaign_.factors[i];
          point.levels.emplace_back(factor.name, LevelValue(resolved, factor, choice.levels[i]));
        }
      } catch (const settings::Error& error) {
        for (const settings::Problem& problem : error.problems()) {
          file.Reject(choice, problem.key, problem.key.empty() ? settings::ToString(problem) : problem.message);
        }
      }
    }
  }
  file.ThrowIfBad();
}

Experiment CampaignWork::ExperimentOf(const campaign::TaskChoice& choice) const {
  Experiment experiment = Input([&] { return Load(campaign_, choice); });
  if (DigestOfSettings(experiment) != points_[choice.point].settings[choice.system]) {
    throw BadInput(campaign_.scenarios[choice.scenario].file.string() + ": has changed since the campaign began");
  }
  return experiment;
}

void CampaignWork::NameSequences(const std::vector<std::size_t>& points, const campaign::ProcessLimits& limits) {
  std::string problems;
  for (const std::size_t p : points) {
    CampaignPoint& point = points_[p];
    if (!point.images || !point.sequence.empty()) continue;
    const sim::Scenario scenario = ExperimentOf(AtPoint(campaign_, p, 0)).scenario;
    if (!WorldIsKnown(scenario, cache_)) {
      campaign::ProcessPool pool;
      pool.Start(0, limits, [&] {
        try {
          FindWorld(scenario, cache_);
        } catch (const BadInput& error) {
          throw std::invalid_argument(error.what());
        }
      });
      std::optional<campaign::ProcessEnd> end;
      while (!(end = pool.Wait(std::chrono::milliseconds(100)))) {
        if (InterruptPending()) throw Interrupted("the campaign was interrupted before it began");
      }
      if (end->work_failed) throw std::runtime_error(end->problem);
      if (!end->problem.empty()) {
        if (problems.find(end->problem) == std::string::npos) problems += (problems.empty() ? "" : "\n") + end->problem;
        continue;
      }
      cache_ = campaign::SequenceCache(cache_.folder());  // files are read again
    }
    point.sequence = SequenceKey(scenario, cache_);
  }
  if (!problems.empty()) throw BadInput(problems);
}

std::string CampaignWork::KeyOf(const campaign::TaskChoice& choice) const {
  const CampaignPoint& point = points_[choice.point];
  const campaign::SystemEntry& system = campaign_.systems[choice.system];
  return campaign::Digest(
      fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", program_, point.settings[choice.system], point.sequence,
                  system.system, system.system.empty() ? campaign::Description(system.external) : "",
                  campaign_.seeds[choice.seed], evaluation::Name(campaign_.align), static_cast<int>(campaign_.keep)));
}

campaign::TaskRecord CampaignWork::BlankRecord(std::int64_t task) const {
  const campaign::TaskChoice choice = campaign::ChoiceOf(campaign_, task);
  campaign::TaskRecord record;
  record.key = KeyOf(choice);
  record.task = task;
  record.scenario = campaign_.scenarios[choice.scenario].name;
  record.system = campaign_.systems[choice.system].name;
  record.levels = points_[choice.point].levels;
  record.seed = campaign_.seeds[choice.seed];
  return record;
}

}  // namespace vobench
