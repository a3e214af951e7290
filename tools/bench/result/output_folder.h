// Output folder written under a temporary name beside its final one and renamed when complete, or removed.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "tools/base/files.h"

namespace vobench {

class OutputFolder : public base::AtomicFolder {
 public:
  // May replace an existing folder only if that is empty, or is one of ours: it has the file `marker`, and at its top
  // level nothing but the names in `ours`. Throws BadInput naming the obstacle, std::runtime_error when the temporary
  // folder cannot be made.
  OutputFolder(const std::filesystem::path& final_path, const std::string& marker, const std::set<std::string>& ours);
};

// The absolute path, normalised and without a slash at the end: of "out/demo/" and "out/./demo" .../out/demo.
std::filesystem::path CleanPath(const std::filesystem::path& path);

// Throws BadInput where `path` is anything but a folder, dangling links included.
void RequireFolderIfThere(const std::filesystem::path& path);

// Throws BadInput unless `folder` is absent, empty or one of ours, as above: a check before long work.
void RequireReplaceable(const std::filesystem::path& folder, const std::string& marker,
                        const std::set<std::string>& ours);

}  // namespace vobench
