// Folder of one task, written whole or not at all, and the record read from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "tools/bench/campaign/file_lock.h"
#include "tools/bench/campaign/results.h"

namespace vobench::campaign {

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

}  // namespace vobench::campaign
