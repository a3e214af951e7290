#include "tools/bench/campaign/task_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "tools/judge/evaluation/whole_file.h"

namespace vobench::campaign {
namespace fs = std::filesystem;

fs::path TaskPath(const fs::path& out, std::int64_t task) {
  constexpr std::int64_t kInOneFolder = 10'000;
  return out / "tasks" / fmt::format("{:02}", task / kInOneFolder) / fmt::format("{:06}", task);
}

std::optional<TaskRecord> ReadRecord(const fs::path& out, std::int64_t task) {
  std::ifstream stream(TaskPath(out, task) / "task.json", std::ios::binary);
  if (!stream) return std::nullopt;
  try {
    TaskRecord record = RecordFromJson({std::istreambuf_iterator<char>(stream), {}});
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
  evaluation::WriteWhole(hidden_ / "task.json", ToJson(record));
  fs::path old = hidden_;
  old.replace_extension("old");
  std::error_code error;
  fs::remove_all(old, error);
  const bool replaces = fs::exists(final_);
  if (replaces) fs::rename(final_, old, error);
  if (!error) fs::rename(hidden_, final_, error);
  if (error)
    throw std::runtime_error(fmt::format("{}: cannot be given its name: {}", final_.string(), error.message()));
  committed_ = true;
  if (replaces) fs::remove_all(old, error);
}

}  // namespace vobench::campaign
