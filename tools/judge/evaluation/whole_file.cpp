#include "tools/judge/evaluation/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

namespace evaluation {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

}  // namespace

// Not with stdio, which gives a signal during a write out as an error.
WholeFile::WholeFile(std::filesystem::path file) : file_(std::move(file)), temporary_(file_) {
  temporary_ += ".part";
  do {
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0) Fail({errno, std::generic_category()});
}

WholeFile::~WholeFile() {
  if (temporary_.empty()) return;
  if (descriptor_ >= 0) close(descriptor_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void WholeFile::Fail(const std::error_code& why) const {
  throw std::runtime_error(file_.string() + ": cannot be written: " + why.message());
}

void WholeFile::Append(std::string_view text) {
  if (buffer_.size() + text.size() > kBufferBytes) Flush();
  if (text.size() > kBufferBytes) return Write(text);
  buffer_ += text;
}

void WholeFile::Flush() {
  Write(buffer_);
  buffer_.clear();
}

void WholeFile::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    if (written == 0) Fail({EIO, std::generic_category()});
    if (written < 0 && errno != EINTR) Fail({errno, std::generic_category()});
  }
}

void WholeFile::Commit() {
  Flush();
  // Interrupted, it is closed all the same.
  if (close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) Fail({errno, std::generic_category()});
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error) Fail(error);
  temporary_.clear();
}

void WriteWhole(const std::filesystem::path& file, const std::string& content) {
  WholeFile whole(file);
  whole.Append(content);
  whole.Commit();
}

}  // namespace evaluation
