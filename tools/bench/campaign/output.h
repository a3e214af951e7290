// Output folder of a campaign: lock, folders of the tasks, and the tables over all tasks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/curves.h"
#include "tools/bench/campaign/file_lock.h"
#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/table.h"

namespace vobench::campaign {

// Makes the folder and its marker, campaign.json, with `text` where it is new. Throws BadInput where the folder is
// another program's, std::runtime_error.
void PrepareOutput(const std::filesystem::path& out, const std::string& text);

// Shared by single tasks, exclusive for a whole campaign. Waits a moment for processes of a killed campaign to end.
// Throws std::runtime_error when another campaign is running.
FileLock LockOutput(const std::filesystem::path& out, FileLock::Kind kind);

// OUT/tasks/00/000123
std::filesystem::path TaskPath(const std::filesystem::path& out, std::int64_t task);

// task.json of a task; none where there is none or it cannot be read: the task is done again.
std::optional<TaskRecord> ReadRecord(const std::filesystem::path& out, std::int64_t task);

// Lock of a task for this process, and its folder to write in. A killed process leaves the folder under its hidden
// name; the next one begins with an empty folder.
class TaskFolder {
 public:
  // Throws std::runtime_error when it cannot be made, and when another process is at work on this task.
  TaskFolder(const std::filesystem::path& out, std::int64_t task);
  // Removes what was not committed.
  ~TaskFolder();
  TaskFolder(const TaskFolder&) = delete;
  TaskFolder& operator=(const TaskFolder&) = delete;

  const std::filesystem::path& path() const { return hidden_; }

  // Writes task.json and renames the folder to its final name; replaces an older one. Throws std::runtime_error.
  void Commit(const TaskRecord& record);

 private:
  std::filesystem::path final_, hidden_;
  std::optional<FileLock> lock_;  // on the hidden folder
  bool committed_ = false;
};

// Tasks that have a folder, in order. Folders are listed, no file is opened: a hundredth of the time for a million.
std::vector<std::int64_t> PresentTasks(const std::filesystem::path& out);

struct OutputState {
  std::vector<std::int64_t> missing;  // and failed
  std::vector<std::int64_t> stale;    // of other settings, another program, or beyond the last task
};

// Moves results whose keys belong to other tasks' numbers, as after a system was added, to those numbers. Needs the
// exclusive lock. An interrupted call is completed by the next one.
void Renumber(const std::filesystem::path& out, const std::vector<std::string>& keys);

// keys[k]: what task k's result must depend on.
OutputState Inspect(const std::filesystem::path& out, const std::vector<std::string>& keys);

// Removes those of these tasks that have failed; results written by others in the meantime stay.
void RemoveFailed(const std::filesystem::path& out, const std::vector<std::int64_t>& tasks);

// Results of all tasks together.
struct Merged {
  std::vector<TaskRecord> records;  // in order, lost ones by the campaign's rule
  std::vector<Table> tables;
  std::vector<Curve> curves;
};

// Writes results.csv, times.csv, tables.md, tables.tex, and curves.csv where the campaign has curves, from the tasks'
// folders alone; names and levels are the campaign's present ones. levels[p]: of point p. Throws std::runtime_error
// unless all tasks are present.
Merged Merge(const Campaign& campaign, const std::vector<LevelValues>& levels, const std::filesystem::path& out);

}  // namespace vobench::campaign
