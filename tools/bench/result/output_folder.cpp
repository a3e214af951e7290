#include "tools/bench/result/output_folder.h"

#include <fmt/format.h>

#include "tools/bench/errors.h"

namespace vobench {
namespace fs = std::filesystem;

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
    : AtomicFolder((RequireReplaceable(CleanPath(final_path), marker, ours), CleanPath(final_path))) {}

}  // namespace vobench
