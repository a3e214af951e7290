// File input and output on POSIX: atomic replacement of files and folders, system calls repeated after signals.
//
// A file or folder is written under a hidden temporary name beside its final name, so on the same file system, and
// renamed when it is complete. Without Commit nothing remains, and what had the final name before is untouched. Nothing
// is flushed to the device (fsync). All functions throw std::runtime_error with the path and the system's reason.
#pragma once

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace base {

// The result of a system call that is repeated while signals interrupt it (EINTR).
template <class Call>
auto Uninterrupted(Call&& call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

// The owner of a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int file = -1) : file_(file) {}
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~Descriptor() { Close(); }

  int operator*() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }
  // Returns errno, 0 without an error. Also a close that a signal interrupts has closed the file.
  int Close();

 private:
  int file_;
};

// Writes all bytes in as many calls as it takes. Returns errno, 0 without an error.
int WriteAll(int file, std::string_view bytes);

// The content of a file; none when it cannot be opened.
std::optional<std::string> ReadFile(const std::filesystem::path& file);

inline std::span<const std::uint8_t> AsBytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string_view AsText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// ".NAME.part", the temporary name of a file.
std::string UnfinishedName(const std::string& name);

// The number of processes, on one machine or several, that may write a file at the same time. With `many` the temporary
// name is random, and one that a killed process leaves is never replaced.
enum class Writers { one, many };

// A temporary path for a file that another library writes.
class AtomicPath {
 public:
  explicit AtomicPath(std::filesystem::path file, Writers writers = Writers::one);
  AtomicPath(std::filesystem::path file, std::filesystem::path temporary);
  ~AtomicPath();  // removes the temporary file
  AtomicPath(const AtomicPath&) = delete;
  AtomicPath& operator=(const AtomicPath&) = delete;

  const std::filesystem::path& file() const { return file_; }
  const std::filesystem::path& path() const { return temporary_; }
  void Commit();

 private:
  std::filesystem::path file_, temporary_;
  bool committed_ = false;
};

// A file that is replaced atomically. The folder must exist.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path file, Writers writers = Writers::one);

  void Append(std::string_view bytes);
  // At the file's beginning, in place of as many bytes: the last thing before Commit.
  void Overwrite(std::string_view bytes);
  void Commit();

 private:
  void Flush();

  AtomicPath path_;
  Descriptor descriptor_;
  std::string buffer_;
};

// AtomicFile in one call; the second one also makes the folders above the file.
void WriteFile(const std::filesystem::path& file, std::string_view bytes, Writers writers = Writers::one);
void WriteFileAndFolders(const std::filesystem::path& file, std::string_view bytes);

// WriteFileAndFolders of at most as many bytes as the file has. Without room for a second file they overwrite its
// beginning.
void ShortenFile(const std::filesystem::path& file, std::string_view bytes);

// Appends in one system call, if the system takes all bytes at once.
void AppendToFile(const std::filesystem::path& file, std::string_view bytes);

// A folder that is replaced atomically: filled under a temporary name of this process, then renamed.
class AtomicFolder {
 public:
  // Makes the temporary folder, and those above it.
  explicit AtomicFolder(std::filesystem::path folder);
  ~AtomicFolder();  // without Commit removes all that was made
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  const std::filesystem::path& path() const { return temporary_; }
  void Commit();

 private:
  void Discard();

  std::filesystem::path final_, temporary_;
  std::vector<std::filesystem::path> made_parents_;  // outermost first
  bool committed_ = false;
};

// Renames a folder; an older one with the name `to` is removed, and stays in place when renaming fails.
void ReplaceFolder(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace base
