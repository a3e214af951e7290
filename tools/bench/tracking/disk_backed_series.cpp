#include "tools/bench/tracking/disk_backed_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace vobench {

void SeriesFile::Fail(const char* what, int why) const {
  throw std::runtime_error(
      fmt::format("{}: {} what a long run has answered so far: {}", folder_.string(), what, std::strerror(why)));
}

void SeriesFile::Open() {
  constexpr int kFlags = O_CLOEXEC | O_APPEND;
  file_ =
      base::Descriptor(base::Uninterrupted([&] { return open(folder_.c_str(), O_TMPFILE | O_RDWR | kFlags, 0600); }));
  if (file_) return;
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) Fail("cannot keep", errno);
  std::string name = (folder_ / ".spool-XXXXXX").string();  // for a file system without unnamed files
  file_ = base::Descriptor(mkostemp(name.data(), kFlags));
  if (!file_ || unlink(name.c_str()) != 0) Fail("cannot keep", errno);
}

void SeriesFile::Append(const void* bytes, std::size_t count) {
  if (!file_) Open();
  if (const int error = base::WriteAll(*file_, {static_cast<const char*>(bytes), count})) Fail("cannot keep", error);
}

void SeriesFile::Read(std::uint64_t offset, void* bytes, std::size_t count) const {
  char* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = base::Uninterrupted([&] { return pread(*file_, next, count, static_cast<off_t>(offset)); });
    if (got <= 0) Fail("cannot read", got < 0 ? errno : EIO);
    next += got;
    offset += static_cast<std::uint64_t>(got);
    count -= static_cast<std::size_t>(got);
  }
}

}  // namespace vobench
