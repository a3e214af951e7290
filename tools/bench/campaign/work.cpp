#include "tools/bench/campaign/work.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "tools/bench/campaign/campaign_file.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

// The value of a dotted key in SI, where there is such a number; or else as the campaign writes it.
std::string LevelValue(const nlohmann::json& resolved, const Factor& factor, std::size_t level) {
  const nlohmann::json* value = &resolved;
  std::istringstream parts(factor.key);
  for (std::string part; value != nullptr && std::getline(parts, part, '.');) {
    value = value->is_object() && value->contains(part) ? &value->at(part) : nullptr;
  }
  return value != nullptr && value->is_number() ? value->dump() : factor.levels[level].name;
}

// A task of `point` with `system`, for data common to all seeds.
TaskChoice AtPoint(const Campaign& campaign, std::size_t point, std::size_t system) {
  return ChoiceOf(campaign, static_cast<std::int64_t>(point * campaign.systems.size() + system));
}

}  // namespace

CampaignWork::CampaignWork(const fs::path& file, fs::path cache, const TaskRunner& runner)
    : runner_(runner), cache_(std::move(cache)), program_(DigestOfFile("/proc/self/exe")) {
  Input([&] { Resolve(file); });
}

void CampaignWork::Resolve(const fs::path& path) {
  CampaignFile file(path, runner_.Systems(), runner_.ImagesAlone());
  campaign_ = file.campaign();
  const std::size_t points = file.complete() ? Points(campaign_) : 0;
  for (std::size_t p = 0; p < points; ++p) {
    CampaignPoint& point = points_.emplace_back();
    for (std::size_t s = 0; s < campaign_.systems.size(); ++s) {
      const TaskChoice choice = AtPoint(campaign_, p, s);
      try {
        const TaskSettings settings = runner_.Settings(
            campaign_, choice,
            [&](const std::string& key, const std::string& message) { file.Reject(choice, key, message); });
        point.settings.push_back(settings.digest);
        if (s > 0) continue;
        point.images = settings.images;
        const nlohmann::json resolved = nlohmann::json::parse(settings.resolved);
        for (std::size_t i = 0; i < campaign_.factors.size(); ++i) {
          const Factor& factor = campaign_.factors[i];
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

void CampaignWork::RequireUnchanged(const TaskChoice& choice) const {
  const TaskSettings now = Input([&] { return runner_.Settings(campaign_, choice, [](const auto&, const auto&) {}); });
  if (now.digest != points_[choice.point].settings[choice.system]) {
    throw BadInput(campaign_.scenarios[choice.scenario].file.string() + ": has changed since the campaign began");
  }
}

void CampaignWork::NameSequences(const std::vector<std::size_t>& points, const ProcessLimits& limits) {
  std::string problems;
  for (const std::size_t p : points) {
    CampaignPoint& point = points_[p];
    if (!point.images || !point.sequence.empty()) continue;
    const TaskChoice choice = AtPoint(campaign_, p, 0);
    RequireUnchanged(choice);
    std::optional<std::string> name = runner_.SequenceName(campaign_, choice, cache_);
    if (!name) {
      ProcessPool pool;
      pool.Start(0, limits, [&] { runner_.ReadWorld(campaign_, choice, cache_); });
      std::optional<ProcessEnd> end;
      while (!(end = pool.Wait(std::chrono::milliseconds(100)))) {
        if (InterruptPending()) throw Interrupted("the campaign was interrupted before it began");
      }
      if (end->work_failed) throw std::runtime_error(end->problem);
      if (!end->problem.empty()) {
        if (problems.find(end->problem) == std::string::npos) problems += (problems.empty() ? "" : "\n") + end->problem;
        continue;
      }
      cache_ = SequenceCache(cache_.folder());  // files are read again
      name = runner_.SequenceName(campaign_, choice, cache_);
    }
    point.sequence = name.value();
  }
  if (!problems.empty()) throw BadInput(problems);
}

void CampaignWork::Render(std::size_t point, int threads) const {
  const TaskChoice choice = AtPoint(campaign_, point, 0);
  RequireUnchanged(choice);
  runner_.Render(campaign_, choice, cache_, points_[point].sequence, threads);
}

void CampaignWork::Run(const fs::path& out, std::int64_t task) const {
  const TaskChoice choice = ChoiceOf(campaign_, task);
  RequireUnchanged(choice);
  TaskFolder folder(out, task);
  TaskRecord record = BlankRecord(task);
  record.status = Status::ok;
  runner_.Run(campaign_, choice, cache_, points_[choice.point].sequence, folder.path(), record);
  folder.Commit(record);
}

void CampaignWork::RecordFailure(const fs::path& out, std::int64_t task, const std::string& reason) const {
  TaskFolder folder(out, task);
  TaskRecord record = BlankRecord(task);
  record.status = Status::failed;
  record.reason = reason;
  folder.Commit(record);
}

std::string CampaignWork::KeyOf(const TaskChoice& choice) const {
  const CampaignPoint& point = points_[choice.point];
  const SystemEntry& system = campaign_.systems[choice.system];
  const Omitted& omit = campaign_.omit;
  return Digest(fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{} {}", program_, point.settings[choice.system],
                            point.sequence, system.system, system.system.empty() ? Description(system.external) : "",
                            campaign_.seeds[choice.seed], evaluation::Name(AlignmentOf(campaign_, system)),
                            static_cast<int>(campaign_.keep), omit.from_s, omit.until_s));
}

TaskRecord CampaignWork::BlankRecord(std::int64_t task) const {
  const TaskChoice choice = ChoiceOf(campaign_, task);
  return {KeyOf(choice),
          task,
          campaign_.scenarios[choice.scenario].name,
          campaign_.systems[choice.system].name,
          points_[choice.point].levels,
          campaign_.seeds[choice.seed]};
}

}  // namespace vobench::campaign
