// Contract of all fuzz targets: for any input bytes a reader returns, or throws a std::exception that names the file.
// All else is a finding and ends the program: other exceptions here, memory errors by the sanitizers, time and memory
// limits by the caller of the target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace fuzz {

using Bytes = std::span<const std::uint8_t>;

// Temporary folder of the process, in /dev/shm where available. The first call makes it the working folder; it is
// deleted at exit.
const std::filesystem::path& Folder();

// Input file of a fixed name, rewritten in each run. Kept open: one write per run.
class InputFile {
 public:
  // `name`: relative to Folder(). Creates the parent folders.
  explicit InputFile(const std::string& name);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Relative to Folder(): a short string, whose copies in a reader take no heap memory.
  const std::filesystem::path& path() const { return path_; }
  void Write(Bytes bytes);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

// Writes another file below Folder().
void WriteBeside(const std::string& name, const std::string& content);

// Reports a finding on stderr and aborts.
[[noreturn]] void Finding(const std::string& what);

// Runs a reader. A finding: an exception that is no std::exception, or whose text lacks `named` (the file's path).
void Hold(const std::string& named, const std::function<void()>& read);

// The same for a reader of text without a file: only E may be thrown.
template <class E>
void HoldText(const std::function<void()>& read) {
  try {
    read();
  } catch (const E&) {
  } catch (const std::exception& error) {
    Finding(std::string("another exception than promised: ") + error.what());
  }
}

}  // namespace fuzz
