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

// Makes the folder, and the mark that says what it is: campaign.json, with `text` where it is new. Throws BadInput
// where there is something else's folder, std::runtime_error.
void PrepareOutput(const std::filesystem::path& out, const std::string& text);

// Single tasks share the folder, a whole campaign has it for itself. A killed one's processes are given a moment to
// end. Throws std::runtime_error when another one is at work.
FileLock LockOutput(const std::filesystem::path& out, FileLock::Kind kind);

// OUT/tasks/00/000123
std::filesystem::path TaskPath(const std::filesystem::path& out, std::int64_t task);

// task.json of a task; none where there is none or it cannot be read: the task is done again.
std::optional<TaskRecord> ReadRecord(const std::filesystem::path& out, std::int64_t task);

// Takes the task for this process, and makes the folder to write in. A kill leaves it under its hidden name; whoever
// takes the task next begins with an empty one.
class TaskFolder {
 public:
  // Throws std::runtime_error when it cannot be made, and when another process is at work on this task.
  TaskFolder(const std::filesystem::path& out, std::int64_t task);
  // Removes what was not committed.
  ~TaskFolder();
  TaskFolder(const TaskFolder&) = delete;
  TaskFolder& operator=(const TaskFolder&) = delete;

  const std::filesystem::path& path() const { return hidden_; }

  // Writes task.json and gives the folder its name; an older one of that name goes. Throws std::runtime_error.
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

// Results of these keys that lie at other tasks' numbers, as after a system was added, go to theirs. For who has the
// folder alone. What is cut short is completed by the next call.
void Renumber(const std::filesystem::path& out, const std::vector<std::string>& keys);

// keys[k]: what task k's result must depend on.
OutputState Inspect(const std::filesystem::path& out, const std::vector<std::string>& keys);

// Of these tasks those that have failed; what others may have done in the meantime stays.
void RemoveFailed(const std::filesystem::path& out, const std::vector<std::int64_t>& tasks);

// What all tasks together say.
struct Merged {
  std::vector<TaskRecord> records;  // in order, lost ones by the campaign's rule
  std::vector<Table> tables;
  std::vector<Curve> curves;
};

// Writes results.csv, times.csv, tables.md, tables.tex, and curves.csv where the campaign asks for curves, from the
// tasks' folders alone; names and levels are the campaign's, whatever they were when a task ran. levels[p]: of point p.
// All tasks must be there (std::runtime_error).
Merged Merge(const Campaign& campaign, const std::vector<LevelValues>& levels, const std::filesystem::path& out);

}  // namespace vobench::campaign
