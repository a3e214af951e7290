#include "tools/bench/result/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "tools/bench/errors.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

// Hidden, beside its final name (the same file system, so that renaming is atomic), and another for each process.
fs::path Beside(const fs::path& path, const std::string& what) {
  return path.parent_path() / fmt::format(".{}.{}-{}", path.filename().string(), what, getpid());
}

}  // namespace

fs::path CleanPath(const fs::path& path) {
  fs::path clean = fs::absolute(path).lexically_normal();
  return clean.has_filename() ? clean : clean.parent_path();
}

void RequireFolderIfThere(const fs::path& path) {
  const fs::file_status own = fs::symlink_status(path);
  if (!fs::exists(own) || fs::is_directory(path)) return;
  if (fs::is_symlink(own) && !fs::exists(path)) {
    throw BadInput(
        fmt::format("{}: is a link to {}, which is not there", path.string(), fs::read_symlink(path).string()));
  }
  throw BadInput(fmt::format("{}: is there and is no folder", path.string()));
}

void RequireReplaceable(const fs::path& folder, const std::string& marker, const std::set<std::string>& ours) {
  RequireFolderIfThere(folder);
  if (!fs::exists(folder) || fs::is_empty(folder)) return;
  if (!fs::exists(folder / marker)) {
    throw BadInput(fmt::format("{}: is there already and not made by this command (it has no {}); choose another name",
                               folder.string(), marker));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!ours.contains(entry.path().filename().string())) {
      throw BadInput(
          fmt::format("{}: is in the folder that would be replaced, and not ours; move it or choose another name",
                      entry.path().string()));
    }
  }
}

OutputFolder::OutputFolder(const fs::path& final_path, const std::string& marker, const std::set<std::string>& ours)
    : final_(CleanPath(final_path)) {
  RequireReplaceable(final_, marker, ours);
  for (fs::path parent = final_.parent_path(); !fs::exists(parent); parent = parent.parent_path()) {
    made_parents_.insert(made_parents_.begin(), parent);
  }
  std::error_code error;
  fs::create_directories(final_.parent_path(), error);
  // A folder that a killed process of the same number left behind is not taken over.
  for (int n = 0; !error; ++n) {
    temporary_ = Beside(final_, fmt::format("partial{}", n));
    if (fs::create_directory(temporary_, error)) break;
  }
  if (error) {
    Discard();
    throw std::runtime_error(fmt::format("{}: cannot make this folder: {}", final_.string(), error.message()));
  }
}

OutputFolder::~OutputFolder() {
  if (!committed_) Discard();
}

void OutputFolder::Discard() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  std::for_each(made_parents_.rbegin(), made_parents_.rend(),
                [&](const fs::path& parent) { fs::remove(parent, ignored); });
}

void OutputFolder::Commit() {
  ReplaceFolder(temporary_, final_);
  committed_ = true;
}

void ReplaceFolder(const fs::path& from, const fs::path& to) {
  const fs::path old = Beside(to, "old");
  const bool replaces = fs::exists(fs::symlink_status(to));
  std::error_code error, ignored;
  if (replaces) fs::rename(to, old, error);
  if (!error) {
    fs::rename(from, to, error);
    if (error && replaces) fs::rename(old, to, ignored);
  }
  if (error)
    throw std::runtime_error(fmt::format("{}: cannot give the result this name: {}", to.string(), error.message()));
  if (replaces) fs::remove_all(old, ignored);
}

}  // namespace vobench
