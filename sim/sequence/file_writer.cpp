#include "sim/sequence/file_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace sim {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void Fail(const fs::path& path, int error) {
  throw std::runtime_error(path.string() + ": cannot be written: " + std::generic_category().message(error));
}

// Tried again as long as a signal interrupts it.
template <class Call>
auto Uninterrupted(Call&& call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

// A file that is open for writing; closed at the end, come what may.
class OpenFile {
 public:
  // `shown` is named in errors.
  OpenFile(const fs::path& path, int flags, const fs::path& shown)
      : file_(Uninterrupted([&] { return open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666); })), shown_(shown) {
    if (file_ < 0) Fail(shown_, errno);
  }
  ~OpenFile() {
    if (file_ >= 0) close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void Write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = Uninterrupted([&] { return write(file_, bytes.data(), bytes.size()); });
      if (written <= 0) Fail(shown_, written < 0 ? errno : EIO);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }
  void Cut(std::size_t size) {
    if (Uninterrupted([&] { return ftruncate(file_, static_cast<off_t>(size)); }) != 0) Fail(shown_, errno);
  }
  void Close() {
    const int file = std::exchange(file_, -1);
    if (close(file) != 0 && errno != EINTR) Fail(shown_, errno);  // interrupted, it is closed all the same
  }

 private:
  int file_;
  const fs::path& shown_;
};

}  // namespace

std::string UnfinishedName(const std::string& name) { return "." + name + ".part"; }

void WriteFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) Fail(path, error.value());
  const fs::path unfinished = path.parent_path() / UnfinishedName(path.filename().string());
  try {
    OpenFile file(unfinished, O_CREAT | O_TRUNC, path);
    file.Write(bytes);
    file.Close();
    fs::rename(unfinished, path, error);
    if (error) Fail(path, error.value());
  } catch (...) {
    fs::remove(unfinished, error);
    throw;
  }
}

void ShortenFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
  try {
    WriteFile(path, bytes);
  } catch (const std::runtime_error&) {
    OpenFile file(path, 0, path);
    file.Write(bytes);
    file.Cut(bytes.size());
    file.Close();
  }
}

void AppendToFile(const fs::path& path, std::span<const std::uint8_t> bytes) {
  OpenFile file(path, O_CREAT | O_APPEND, path);
  file.Write(bytes);
  file.Close();
}

}  // namespace sim
