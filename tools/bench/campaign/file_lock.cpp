#include "tools/bench/campaign/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace vobench::campaign {
namespace {

base::Descriptor Open(const std::filesystem::path& path) {
  const int flags = std::filesystem::is_directory(path) ? O_RDONLY | O_DIRECTORY : O_RDWR | O_CREAT;
  base::Descriptor file(base::Uninterrupted([&] { return open(path.c_str(), flags | O_CLOEXEC, 0666); }));
  if (!file) throw std::runtime_error(path.string() + ": cannot be opened: " + std::generic_category().message(errno));
  return file;
}

// Whether it could: `how` with LOCK_NB does not wait for another process.
bool Lock(const base::Descriptor& file, const std::filesystem::path& path, int how) {
  if (base::Uninterrupted([&] { return flock(*file, how); }) == 0) return true;
  if (errno == EWOULDBLOCK) return false;
  throw std::runtime_error(path.string() + ": cannot be locked: " + std::generic_category().message(errno));
}

}  // namespace

std::optional<FileLock> FileLock::Try(const std::filesystem::path& path, Kind kind) {
  FileLock lock(Open(path));
  if (!Lock(lock.file_, path, (kind == Kind::shared ? LOCK_SH : LOCK_EX) | LOCK_NB)) return std::nullopt;
  return lock;
}

FileLock FileLock::Wait(const std::filesystem::path& path, Kind kind) {
  FileLock lock(Open(path));
  Lock(lock.file_, path, kind == Kind::shared ? LOCK_SH : LOCK_EX);
  return lock;
}

bool FileLock::Holds(const std::filesystem::path& path) const {
  struct stat ours {
  }, named{};
  return fstat(*file_, &ours) == 0 && stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace vobench::campaign
