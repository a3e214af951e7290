#include "tools/bench/tracking/disk_backed_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace vobench {

SeriesFile::~SeriesFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

SeriesFile::SeriesFile(SeriesFile&& other) noexcept
    : folder_(std::move(other.folder_)), size_(other.size_), descriptor_(std::exchange(other.descriptor_, -1)) {}

void SeriesFile::Fail(const char* what, int why) const {
  throw std::runtime_error(
      fmt::format("{}: {} what a long run has answered so far: {}", folder_.string(), what, std::strerror(why)));
}

void SeriesFile::Open() {
  do {
    descriptor_ = open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ >= 0) return;
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) Fail("cannot keep", errno);
  std::string name = (folder_ / ".spool-XXXXXX").string();  // a file system without files that have no name
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0 || unlink(name.c_str()) != 0) Fail("cannot keep", errno);
}

void SeriesFile::Append(const void* bytes, std::size_t count) {
  if (descriptor_ < 0) Open();
  const char* next = static_cast<const char*>(bytes);
  std::uint64_t offset = size_;
  size_ += count;
  while (count > 0) {
    const ssize_t written = pwrite(descriptor_, next, count, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) Fail("cannot keep", written < 0 ? errno : EIO);
    next += written;
    offset += static_cast<std::uint64_t>(written);
    count -= static_cast<std::size_t>(written);
  }
}

void SeriesFile::Read(std::uint64_t offset, void* bytes, std::size_t count) const {
  char* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = pread(descriptor_, next, count, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) Fail("cannot read", got < 0 ? errno : EIO);
    next += got;
    offset += static_cast<std::uint64_t>(got);
    count -= static_cast<std::size_t>(got);
  }
}

}  // namespace vobench
