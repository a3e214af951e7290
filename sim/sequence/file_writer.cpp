#include "sim/sequence/file_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace sim {

void WriteNewFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const auto fail = [&](int error) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::generic_category().message(error));
  };
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) fail(errno);
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : EIO;
      close(file);
      fail(error);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (close(file) != 0) fail(errno);
}

void WriteNewFile(const std::filesystem::path& path, std::string_view text) {
  WriteNewFile(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace sim
