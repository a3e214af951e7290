#include "tools/bench/campaign/file_lock.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace vobench::campaign {

// `how` with LOCK_NB does not wait for another process.
std::optional<FileLock> FileLock::Take(const std::filesystem::path& path, int how) {
  const auto fail = [&](const char* what) {
    throw std::runtime_error(path.string() + what + std::generic_category().message(errno));
  };
  const int flags = std::filesystem::is_directory(path) ? O_RDONLY | O_DIRECTORY : O_RDWR | O_CREAT;
  base::Descriptor file(base::Uninterrupted([&] { return open(path.c_str(), flags | O_CLOEXEC, 0666); }));
  if (!file) fail(": cannot be opened: ");
  if (base::Uninterrupted([&] { return flock(*file, how); }) == 0) return FileLock(std::move(file));
  if (errno != EWOULDBLOCK) fail(": cannot be locked: ");
  return std::nullopt;
}

std::optional<FileLock> FileLock::Try(const std::filesystem::path& path, Kind kind) {
  return Take(path, static_cast<int>(kind) | LOCK_NB);
}

FileLock FileLock::Wait(const std::filesystem::path& path, Kind kind) {
  return Take(path, static_cast<int>(kind)).value();
}

bool FileLock::Holds(const std::filesystem::path& path) const {
  struct stat ours {
  }, named{};
  return fstat(*file_, &ours) == 0 && stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace vobench::campaign
