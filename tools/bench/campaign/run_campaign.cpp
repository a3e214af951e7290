// Scenarios x varied settings x systems x seeds: each a task with a folder of its own; finished tasks are not repeated.
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/options.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/campaign/page.h"
#include "tools/bench/campaign/slurm.h"
#include "tools/bench/campaign/work.h"
#include "tools/bench/errors.h"
#include "tools/bench/provenance.h"
#include "tools/bench/result/output_folder.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

std::string Record(const Campaign& campaign) {
  nlohmann::ordered_json json = {{"format", "vobench campaign 1"}, {"tasks", Tasks(campaign)}};
  json["order"] = {"seed"};
  for (const std::string& name : VariedNames(campaign)) json["order"].push_back(name);
  json["order"].push_back("system");
  json["versions"] = Versions();
  json["campaign"] = nlohmann::ordered_json::parse(campaign.resolved);
  return json.dump(2) + "\n";
}

Share ShareOf(const CampaignOptions& options, int jobs) {
  Share share = ShareOut(AvailableMemory(), jobs, options.memory_bytes);
  if (share.processes < jobs) {
    fmt::print(stderr, "vobench: {} at a time, not {}: no more of {:.3g} GB fit\n", share.processes, jobs,
               static_cast<double>(share.limits.memory_bytes) * 1e-9);
  }
  share.limits.timeout_s = options.timeout_s;
  return share;
}

std::vector<std::size_t> PointsOf(const Campaign& campaign, const std::vector<std::int64_t>& tasks) {
  std::set<std::size_t> points;
  for (const std::int64_t task : tasks) points.insert(ChoiceOf(campaign, task).point);
  return {points.begin(), points.end()};
}

// Foreseeable problems of external systems, a line each.
std::vector<std::string> Foreseen(const Campaign& campaign) {
  std::vector<std::string> problems;
  for (const SystemEntry& system : campaign.systems) {
    const std::string problem = system.system.empty() ? StartProblem(system.external) : "";
    if (!problem.empty()) problems.push_back(system.name + ": " + problem);
  }
  return problems;
}

void List(const CampaignWork& work) {
  const Campaign& campaign = work.campaign();
  fmt::print("{}: {} scenarios", campaign.name, campaign.scenarios.size());
  for (const Factor& factor : campaign.factors) fmt::print(" x {} {}", factor.levels.size(), factor.name);
  fmt::print(" x {} systems x {} seeds = {} tasks\n", campaign.systems.size(), campaign.seeds.size(), Tasks(campaign));
  for (std::int64_t task = 0; task < Tasks(campaign); ++task) {
    fmt::print("{:6}  {}\n", task, Describe(campaign, ChoiceOf(campaign, task)));
  }
  const std::vector<std::string> problems = Foreseen(campaign);
  if (!problems.empty()) throw BadInput(base::Join(problems, "\n"));
}

// All files of a result, without the times.
std::map<std::string, std::string> FilesOf(const fs::path& folder) {
  std::map<std::string, std::string> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "times.json" || name == "log.txt" || !entry.is_regular_file()) continue;
    files[name] = base::ReadFile(entry.path()).value_or("");
  }
  return files;
}

std::string ShortResult(const Campaign& campaign, const TaskRecord& record) {
  const std::string what = Describe(campaign, ChoiceOf(campaign, record.task));
  std::string text = fmt::format("task {} ({}): {}", record.task, what, Name(record.status));
  if (!record.reason.empty()) text += ", " + record.reason;
  if (!record.metrics.empty() && record.metrics.front()) text += fmt::format(", ATE {:.4g} m", *record.metrics.front());
  return text;
}

// Runs one task alone, replacing its result.
void RunAgain(CampaignWork& work, const CampaignOptions& options) {
  const std::int64_t task = *options.task;
  const TaskChoice choice = Input([&] { return ChoiceOf(work.campaign(), task); });
  const FileLock lock = LockOutput(options.output, FileLock::Kind::shared);
  const Share share = ShareOf(options, 1);
  work.NameSequences({choice.point}, share.limits);
  const fs::path folder = TaskPath(options.output, task);
  const std::optional<TaskRecord> before = ReadRecord(options.output, task);
  const auto files = FilesOf(folder);
  RunLocally(work, options.output, {task}, share);
  const std::optional<TaskRecord> record = ReadRecord(options.output, task);
  if (!record) throw std::runtime_error(folder.string() + ": is not there");
  fmt::print("{}\n", ShortResult(work.campaign(), *record));
  if (record->status == Status::failed) throw std::runtime_error("it failed");
  if (!before || before->key != record->key || before->status == Status::failed) return;
  if (FilesOf(folder) != files) throw std::runtime_error(folder.string() + ": came out different from before");
  fmt::print("the same as before, byte for byte\n");
}

// Runs the unfinished tasks of a list.
void RunPart(CampaignWork& work, const CampaignOptions& options) {
  const std::vector<std::int64_t> listed =
      Input([&] { return ReadArrayLine(*options.list, static_cast<std::size_t>(options.part)); });
  const std::vector<std::size_t> points = Input([&] { return PointsOf(work.campaign(), listed); });
  const FileLock lock = LockOutput(options.output, FileLock::Kind::shared);
  const Share share = ShareOf(options, options.jobs);
  work.NameSequences(points, share.limits);
  std::vector<std::int64_t> left;
  for (const std::int64_t task : listed) {
    const std::optional<TaskRecord> record = ReadRecord(options.output, task);
    const bool done =
        record && record->status != Status::failed && record->key == work.KeyOf(ChoiceOf(work.campaign(), task));
    if (!done) left.push_back(task);
  }
  RunLocally(work, options.output, left, share);
}

void RefuseStale(const CampaignOptions& options, const OutputState& state, std::int64_t tasks) {
  if (state.stale.empty() || options.update) return;
  throw BadInput(fmt::format(
      "{}: {} results there are not what {} would give now (settings, pictures, seeds or the program have changed), {} "
      "are. --update does these anew and keeps the others; or choose another folder",
      options.output.string(), state.stale.size(), options.file.string(),
      std::max<std::int64_t>(0, tasks - static_cast<std::int64_t>(state.missing.size() + state.stale.size()))));
}

void Conclude(const CampaignWork& work, const CampaignOptions& options) {
  std::vector<LevelValues> levels;
  for (const CampaignPoint& point : work.points()) levels.push_back(point.levels);
  const Merged merged = Merge(work.campaign(), levels, options.output);
  base::WriteFile(options.output / "report.html", CampaignPage(work.campaign(), merged), base::Writers::many);
  if (!options.quiet) {
    fmt::print("{}\n", base::ReadFile(options.output / "tables.md").value_or(""));
    if (const std::uint64_t bytes = work.cache().Bytes(); bytes > 0) {
      fmt::print("{:.1f} MB of sequences in {}\n", static_cast<double>(bytes) * 1e-6, work.cache().folder().string());
    }
    fmt::print("{} tasks in {}\nThe report is in {}\n", merged.records.size(),
               (options.output / "results.csv").string(), (options.output / "report.html").string());
  }
  std::size_t failed = 0;
  std::string first;
  for (const TaskRecord& record : merged.records) {
    if (record.status != Status::failed) continue;
    if (failed++ == 0) first = ShortResult(work.campaign(), record);
  }
  if (failed > 0) {
    throw std::runtime_error(fmt::format("{} of {} tasks failed; the same command tries them again. The first: {}",
                                         failed, merged.records.size(), first));
  }
}

void RemoveSystems(const Campaign& campaign, const CampaignOptions& options) {
  for (const std::string& name : options.redo) {
    if (std::ranges::find(campaign.systems, name, &SystemEntry::name) != campaign.systems.end()) continue;
    std::vector<std::string> names;
    for (const SystemEntry& system : campaign.systems) names.push_back(system.name);
    throw BadInput(fmt::format("--redo: there is no system '{}'; there are '{}'", name, fmt::join(names, "', '")));
  }
  for (std::int64_t task = 0; task < Tasks(campaign); ++task) {
    if (std::ranges::count(options.redo, campaign.systems[ChoiceOf(campaign, task).system].name) > 0)
      fs::remove_all(TaskPath(options.output, task));
  }
}

void RunAll(CampaignWork& work, const CampaignOptions& options) {
  const bool slurm = options.engine == "slurm";
  const FileLock lock = LockOutput(options.output, slurm ? FileLock::Kind::shared : FileLock::Kind::exclusive);
  const std::int64_t tasks = Tasks(work.campaign());
  const Share share = ShareOf(options, options.jobs);
  std::vector<std::size_t> points(work.points().size());
  std::iota(points.begin(), points.end(), 0);
  work.NameSequences(points, share.limits);
  std::vector<std::string> keys;
  for (std::int64_t task = 0; task < tasks; ++task) {
    keys.push_back(work.KeyOf(ChoiceOf(work.campaign(), task)));
  }
  if (!slurm) Renumber(options.output, keys);
  RemoveSystems(work.campaign(), options);
  OutputState state = Inspect(options.output, keys);
  RefuseStale(options, state, tasks);
  const std::vector<std::string> foreseen = Foreseen(work.campaign());
  if (!slurm && foreseen.size() == work.campaign().systems.size()) throw BadInput(base::Join(foreseen, "\n"));
  for (const std::string& problem : foreseen) fmt::print(stderr, "vobench: {}\n", problem);
  base::WriteFile(options.output / "campaign.json", Record(work.campaign()), base::Writers::many);
  if (!state.stale.empty()) {
    for (const std::int64_t task : state.stale) fs::remove_all(TaskPath(options.output, task));
    state = Inspect(options.output, keys);
  }
  const auto left = static_cast<std::int64_t>(state.missing.size());
  if (left < tasks) fmt::print(stderr, "{} of {} tasks are done\n", tasks - left, tasks);
  try {
    slurm ? RunOnSlurm(work, options, state.missing) : RunLocally(work, options.output, state.missing, share);
  } catch (const Interrupted&) {
    const std::string jobs = slurm ? fmt::format(" Jobs stay in the queue; `scancel --name={}` ends them.",
                                                 SlurmJobName(fs::absolute(options.output)))
                                   : "";
    throw Interrupted(
        fmt::format("the campaign was interrupted; {} of {} tasks are done, and the same command goes on.{}",
                    tasks - static_cast<std::int64_t>(Inspect(options.output, keys).missing.size()), tasks, jobs));
  }
  Conclude(work, options);
}

}  // namespace

void RunCampaign(const CampaignOptions& asked, const TaskRunner& runner) {
  CampaignOptions options = asked;
  options.output = CleanPath(asked.output);
  options.cache = CleanPath(asked.cache.value_or(options.output / "cache"));
  CampaignWork work(options.file, *options.cache, runner);
  if (options.dry_run) return List(work);
  RequireFolderIfThere(options.output);
  RequireFolderIfThere(*options.cache);
  PrepareOutput(options.output, Record(work.campaign()));
  if (options.task) return RunAgain(work, options);
  if (options.list) return RunPart(work, options);
  RunAll(work, options);
}

}  // namespace vobench::campaign
