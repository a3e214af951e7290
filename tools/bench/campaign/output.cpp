#include "tools/bench/campaign/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "tools/base/files.h"
#include "tools/bench/errors.h"

namespace vobench::campaign {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTimes[] = {
    "wall_s", "cpu_s", "tracking_s", "peak_memory_mb", "frame_features_ms", "frame_matching_ms", "frame_filter_ms"};

// Of a failed task there are none.
std::string TimesLine(const fs::path& out, std::int64_t task) {
  std::ifstream stream(TaskPath(out, task) / "times.json", std::ios::binary);
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  std::string line = std::to_string(task);
  for (const char* name : kTimes) {
    line += ",";
    if (json.is_object() && json.contains(name) && json[name].is_number()) {
      line += fmt::format("{:.6g}", json[name].get<double>());
    }
  }
  return line + "\n";
}

// Whether the folder contains anything else than the files of a new campaign.
bool HasOthers(const fs::path& out) {
  static const std::set<std::string> kOurs = {".lock", "tasks", "cache", "slurm"};
  return std::any_of(fs::directory_iterator(out), {}, [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return !kOurs.contains(name) && !name.starts_with(".campaign.json.");
  });
}

}  // namespace

void PrepareOutput(const fs::path& out, const std::string& text) {
  fs::create_directories(out);
  const fs::path record = out / "campaign.json";
  if (fs::exists(record)) return;
  // Another process may begin the same campaign at the same time: the obstacle is its own record if that exists now.
  if (HasOthers(out) && !fs::exists(record)) {
    throw BadInput(fmt::format("{}: is no campaign's folder (it has no campaign.json) and not empty", out.string()));
  }
  base::WriteFile(record, text, base::Writers::many);
}

FileLock LockOutput(const fs::path& out, FileLock::Kind kind) {
  for (int tries = 0; tries < 50; ++tries) {
    if (std::optional<FileLock> lock = FileLock::Try(out / ".lock", kind)) return std::move(*lock);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error(out.string() + ": another process is at work on this campaign");
}

fs::path TaskPath(const fs::path& out, std::int64_t task) {
  constexpr std::int64_t kInOneFolder = 10'000;
  return out / "tasks" / fmt::format("{:02}", task / kInOneFolder) / fmt::format("{:06}", task);
}

std::optional<TaskRecord> ReadRecord(const fs::path& out, std::int64_t task) {
  const std::optional<std::string> text = base::ReadFile(TaskPath(out, task) / "task.json");
  if (!text) return std::nullopt;
  try {
    TaskRecord record = RecordFromJson(*text);
    if (record.task == task) return record;
  } catch (const std::invalid_argument&) {
    // A loss of power may leave a file without its content.
  }
  return std::nullopt;
}

TaskFolder::TaskFolder(const fs::path& out, std::int64_t task) : final_(TaskPath(out, task)) {
  hidden_ = final_.parent_path() / fmt::format(".{}.partial", final_.filename().string());
  try {
    do {  // the previous owner may just have renamed it
      fs::create_directories(hidden_);
      lock_ = FileLock::Try(hidden_, FileLock::Kind::exclusive);
      if (!lock_) throw std::runtime_error("another process is at work on this task");
    } while (!lock_->Holds(hidden_));
    for (const fs::directory_entry& left : fs::directory_iterator(hidden_)) fs::remove_all(left.path());
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", final_.string(), error.what()));
  }
}

TaskFolder::~TaskFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(hidden_, ignored);
}

void TaskFolder::Commit(const TaskRecord& record) {
  base::WriteFile(hidden_ / "task.json", ToJson(record));
  base::ReplaceFolder(hidden_, final_);
  committed_ = true;
}

std::vector<std::int64_t> PresentTasks(const fs::path& out) {
  std::vector<std::int64_t> present;
  if (!fs::exists(out / "tasks")) return present;
  for (const fs::directory_entry& shard : fs::directory_iterator(out / "tasks")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(shard)) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") == std::string::npos) present.push_back(std::stoll(name));
    }
  }
  std::sort(present.begin(), present.end());
  return present;
}

OutputState Inspect(const fs::path& out, const std::vector<std::string>& keys) {
  OutputState state;
  const std::vector<std::int64_t> present = PresentTasks(out);
  auto next = present.begin();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto task = static_cast<std::int64_t>(k);
    const bool is_present = next != present.end() && *next == task;
    if (is_present) ++next;
    const std::optional<TaskRecord> record = is_present ? ReadRecord(out, task) : std::nullopt;
    if (record && record->key != keys[k]) {
      state.stale.push_back(task);
    } else if (!record || record->status == Status::failed) {
      state.missing.push_back(task);
    }
  }
  state.stale.insert(state.stale.end(), next, present.end());  // of a longer campaign
  return state;
}

void Renumber(const fs::path& out, const std::vector<std::string>& keys) {
  const fs::path moved = out / "tasks" / ".moved";
  std::map<std::string, std::int64_t> wanted;
  for (std::size_t k = 0; k < keys.size(); ++k) wanted[keys[k]] = static_cast<std::int64_t>(k);
  for (const std::int64_t task : PresentTasks(out)) {
    const std::optional<TaskRecord> record = ReadRecord(out, task);
    const auto at = record ? wanted.find(record->key) : wanted.end();
    const bool right =
        static_cast<std::size_t>(task) < keys.size() && record && keys[static_cast<std::size_t>(task)] == record->key;
    if (at == wanted.end() || right || record->status == Status::failed) continue;
    fs::create_directories(moved);
    std::error_code taken;  // the same result, from an interrupted start
    fs::rename(TaskPath(out, task), moved / record->key, taken);
  }
  if (!fs::exists(moved)) return;
  const std::vector<fs::directory_entry> entries(fs::directory_iterator(moved), {});
  for (const fs::directory_entry& entry : entries) {
    const auto at = wanted.find(entry.path().filename().string());
    std::optional<std::string> text = base::ReadFile(entry.path() / "task.json");
    if (at == wanted.end() || !text) continue;
    const fs::path place = TaskPath(out, at->second);
    if (const auto there = ReadRecord(out, at->second); there && there->key == at->first) continue;
    TaskRecord record = RecordFromJson(*text);
    record.task = at->second;
    base::WriteFile(entry.path() / "task.json", ToJson(record));
    fs::remove_all(place);  // stale, or failed
    fs::create_directories(place.parent_path());
    fs::rename(entry.path(), place);
  }
  fs::remove_all(moved);
}

void RemoveFailed(const fs::path& out, const std::vector<std::int64_t>& tasks) {
  for (const std::int64_t task : tasks) {
    const std::optional<TaskRecord> record = ReadRecord(out, task);
    if (record && record->status == Status::failed) fs::remove_all(TaskPath(out, task));
  }
}

Merged Merge(const Campaign& campaign, const std::vector<LevelValues>& levels, const fs::path& out) {
  Merged merged;
  std::string times = "task";
  for (const char* name : kTimes) times += std::string(",") + name;
  times += "\n";
  for (std::int64_t task = 0; task < Tasks(campaign); ++task) {
    std::optional<TaskRecord> record = ReadRecord(out, task);
    if (!record) throw std::runtime_error(fmt::format("{}: task {} is not there", out.string(), task));
    // Names and levels may have changed since the task ran: its result is the same.
    const TaskChoice choice = ChoiceOf(campaign, task);
    LostRule rule = campaign.lost;
    if (campaign.systems[choice.system].external.keyframes) rule.pose_coverage = 0;
    if (const std::string why = record->status == Status::ok ? WhyLost(*record, rule) : ""; !why.empty()) {
      record->status = Status::lost;
      record->reason = why + (record->reason.empty() ? "" : "; " + record->reason);
    }
    if (record->status == Status::crashed)
      record->reason += fmt::format(" ({})", (TaskPath("", task) / "log.txt").string());
    record->scenario = campaign.scenarios[choice.scenario].name;
    record->levels = levels.at(choice.point);
    record->system = campaign.systems[choice.system].name;
    times += TimesLine(out, task);
    merged.records.push_back(std::move(*record));
  }
  for (const TableSpec& spec : campaign.tables) {
    for (Table& table : MakeTables(campaign, spec, merged.records)) merged.tables.push_back(std::move(table));
  }
  merged.curves = MakeCurves(campaign, merged.records);
  base::WriteFile(out / "results.csv", ResultsCsv(campaign, merged.records), base::Writers::many);
  base::WriteFile(out / "times.csv", times, base::Writers::many);
  const std::vector<TextRow> ends = EndRows(campaign, merged.records);
  const std::string how = ends.empty() ? "" : "\n### How the runs ended\n\n" + MarkdownRows(ends, 1);
  base::WriteFile(out / "tables.md", Markdown(merged.tables) + how + CurvesMarkdown(merged.curves),
                  base::Writers::many);
  base::WriteFile(out / "tables.tex", Latex(merged.tables), base::Writers::many);
  if (merged.curves.empty()) {
    fs::remove(out / "curves.csv");  // of a file with curves
  } else {
    base::WriteFile(out / "curves.csv", CurvesCsv(merged.curves), base::Writers::many);
  }
  return merged;
}

}  // namespace vobench::campaign
