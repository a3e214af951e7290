// File lock that ends with its process: flock(2) on a file or a folder.
#pragma once

#include <sys/file.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "tools/base/files.h"

namespace vobench::campaign {

class FileLock {
 public:
  enum class Kind { shared = LOCK_SH, exclusive = LOCK_EX };

  // None when another process holds it. A missing file is created; a folder must exist. Executed programs do not
  // inherit the lock; forked processes do. Throws std::runtime_error where there can be no lock.
  static std::optional<FileLock> Try(const std::filesystem::path& path, Kind kind);
  // Waits for it.
  static FileLock Wait(const std::filesystem::path& path, Kind kind);

  // Whether the path still names what is locked.
  bool Holds(const std::filesystem::path& path) const;

 private:
  explicit FileLock(base::Descriptor file) : file_(std::move(file)) {}
  static std::optional<FileLock> Take(const std::filesystem::path& path, int how);

  base::Descriptor file_;
};

}  // namespace vobench::campaign
