#include "tools/bench/campaign/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace vobench::campaign {
namespace {

int Open(const std::filesystem::path& path) {
  const int flags = std::filesystem::is_directory(path) ? O_RDONLY | O_DIRECTORY : O_RDWR | O_CREAT;
  int file = -1;
  do {
    file = open(path.c_str(), flags | O_CLOEXEC, 0666);
  } while (file < 0 && errno == EINTR);
  if (file < 0)
    throw std::runtime_error(path.string() + ": cannot be opened: " + std::generic_category().message(errno));
  return file;
}

bool Lock(int file, int how) {
  int result = 0;
  do {
    result = flock(file, how);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

}  // namespace

std::optional<FileLock> FileLock::Try(const std::filesystem::path& path, Kind kind) {
  FileLock lock(Open(path));
  if (Lock(lock.file_, (kind == Kind::shared ? LOCK_SH : LOCK_EX) | LOCK_NB)) return lock;
  if (errno == EWOULDBLOCK) return std::nullopt;
  throw std::runtime_error(path.string() + ": cannot be locked: " + std::generic_category().message(errno));
}

FileLock FileLock::Wait(const std::filesystem::path& path, Kind kind) {
  FileLock lock(Open(path));
  if (Lock(lock.file_, kind == Kind::shared ? LOCK_SH : LOCK_EX)) return lock;
  throw std::runtime_error(path.string() + ": cannot be locked: " + std::generic_category().message(errno));
}

FileLock::~FileLock() {
  if (file_ >= 0) close(file_);
}

FileLock::FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

bool FileLock::Holds(const std::filesystem::path& path) const {
  struct stat ours {
  }, named{};
  return fstat(file_, &ours) == 0 && stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace vobench::campaign
