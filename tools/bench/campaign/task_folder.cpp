#include "tools/bench/campaign/task_folder.h"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "tools/base/files.h"

namespace vobench::campaign {
namespace fs = std::filesystem;

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
    do {  // whoever had it before may just have given it its name
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

}  // namespace vobench::campaign
