#include "tools/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <system_error>

namespace base {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

[[noreturn]] void Fail(const fs::path& path, const char* what, const std::error_code& error) {
  throw std::runtime_error(path.string() + ": " + what + ": " + error.message());
}

// Throws for an errno; 0: no error.
void RequireWritten(const fs::path& path, int error) {
  if (error != 0) Fail(path, "cannot be written", {error, std::generic_category()});
}

// `shown`: path in error messages.
Descriptor OpenToWrite(const fs::path& path, int flags, const fs::path& shown) {
  Descriptor file(Uninterrupted([&] { return open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666); }));
  if (!file) RequireWritten(shown, errno);
  return file;
}

fs::path TemporaryPath(const fs::path& file, Writers writers) {
  std::string name = file.filename().string();
  if (writers == Writers::many) {
    std::random_device device;
    for (int n = 0; n < 2; ++n) name += "." + std::to_string(device());
  }
  return file.parent_path() / UnfinishedName(name);
}

}  // namespace

int Descriptor::Close() {
  const int file = std::exchange(file_, -1);
  return file >= 0 && close(file) != 0 && errno != EINTR ? errno : 0;
}

int WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = Uninterrupted([&] { return write(file, bytes.data(), bytes.size()); });
    if (written <= 0) return written < 0 ? errno : EIO;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

std::optional<std::string> ReadFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::error_code unknown;  // of what has no size
  const std::uintmax_t size = fs::file_size(file, unknown);
  std::string bytes(unknown ? 0 : size, 0);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes.append(std::istreambuf_iterator<char>(stream), {});
}

std::string UnfinishedName(const std::string& name) { return "." + name + ".part"; }

AtomicPath::AtomicPath(fs::path file, Writers writers)
    : file_(std::move(file)), temporary_(TemporaryPath(file_, writers)) {}

AtomicPath::AtomicPath(fs::path file, fs::path temporary) : file_(std::move(file)), temporary_(std::move(temporary)) {}

AtomicPath::~AtomicPath() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicPath::Commit() {
  std::error_code error;
  fs::rename(temporary_, file_, error);
  RequireWritten(file_, error.value());
  committed_ = true;
}

// Without stdio, which reports a signal during a write as an error.
AtomicFile::AtomicFile(fs::path file, Writers writers)
    : path_(std::move(file), writers), descriptor_(OpenToWrite(path_.path(), O_CREAT | O_TRUNC, path_.file())) {}

void AtomicFile::Append(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) Flush();
  if (bytes.size() > kBufferBytes) return RequireWritten(path_.file(), WriteAll(*descriptor_, bytes));
  buffer_ += bytes;
}

void AtomicFile::Flush() {
  RequireWritten(path_.file(), WriteAll(*descriptor_, buffer_));
  buffer_.clear();
}

void AtomicFile::Overwrite(std::string_view bytes) {
  Flush();
  RequireWritten(path_.file(), lseek(*descriptor_, 0, SEEK_SET) != 0 ? errno : WriteAll(*descriptor_, bytes));
}

void AtomicFile::Commit() {
  Flush();
  RequireWritten(path_.file(), descriptor_.Close());
  path_.Commit();
}

void WriteFile(const fs::path& file, std::string_view bytes, Writers writers) {
  AtomicFile atomic(file, writers);
  atomic.Append(bytes);
  atomic.Commit();
}

void WriteFileAndFolders(const fs::path& file, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  RequireWritten(file, error.value());
  WriteFile(file, bytes);
}

void ShortenFile(const fs::path& file, std::string_view bytes) {
  try {
    WriteFileAndFolders(file, bytes);
  } catch (const std::runtime_error&) {
    Descriptor old = OpenToWrite(file, 0, file);
    RequireWritten(file, WriteAll(*old, bytes));
    const auto size = static_cast<off_t>(bytes.size());
    if (Uninterrupted([&] { return ftruncate(*old, size); }) != 0) RequireWritten(file, errno);
    RequireWritten(file, old.Close());
  }
}

void AppendToFile(const fs::path& file, std::string_view bytes) {
  Descriptor end = OpenToWrite(file, O_CREAT | O_APPEND, file);
  RequireWritten(file, WriteAll(*end, bytes));
  RequireWritten(file, end.Close());
}

AtomicFolder::AtomicFolder(fs::path folder) : final_(std::move(folder)) {
  for (fs::path parent = final_.parent_path(); !fs::exists(parent); parent = parent.parent_path()) {
    made_parents_.insert(made_parents_.begin(), parent);
  }
  std::error_code error;
  fs::create_directories(final_.parent_path(), error);
  // The folder of a killed process of the same number is not reused.
  const std::string name = "." + final_.filename().string() + ".partial";
  for (int n = 0; !error; ++n) {
    temporary_ = final_.parent_path() / (name + std::to_string(n) + "-" + std::to_string(getpid()));
    if (fs::create_directory(temporary_, error)) break;
  }
  if (!error) return;
  Discard();
  Fail(final_, "cannot make this folder", error);
}

AtomicFolder::~AtomicFolder() {
  if (!committed_) Discard();
}

void AtomicFolder::Discard() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  std::for_each(made_parents_.rbegin(), made_parents_.rend(), [&](const fs::path& made) { fs::remove(made, ignored); });
}

void AtomicFolder::Commit() {
  ReplaceFolder(temporary_, final_);
  committed_ = true;
}

void ReplaceFolder(const fs::path& from, const fs::path& to) {
  fs::path old = from.parent_path() / ("." + from.filename().string() + ".old");
  const bool replaces = fs::exists(fs::symlink_status(to));
  std::error_code error, ignored;
  fs::remove_all(old, error);
  if (!error && replaces) fs::rename(to, old, error);
  if (!error) {
    fs::rename(from, to, error);
    if (error && replaces) fs::rename(old, to, ignored);
  }
  if (error) Fail(to, "cannot give the result this name", error);
  if (replaces) fs::remove_all(old, ignored);
}

}  // namespace base
