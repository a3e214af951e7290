// The contract of every fuzz target: whatever bytes a file holds, its reader returns, or throws an exception
// that names the
// file. Anything else stops the program: another exception is told here, a crash by the sanitizers, time and
// memory by whoever runs the target.
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

// A folder of its own for each process, in memory where the system has such a place; it goes away with the process, which works in it from
// the first call on.
const std::filesystem::path& Folder();

// A file whose content changes from run to run, always under the same name. Kept open: a run costs one write.
class InputFile {
 public:
  // `name` is below Folder(); its folders are made.
  explicit InputFile(const std::string& name);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Relative to Folder(): short, so that a reader's many copies of it take no memory.
  const std::filesystem::path& path() const { return path_; }
  void Write(Bytes bytes);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

// Writes a file beside the input, once.
void WriteBeside(const std::string& name, const std::string& content);

// A finding: says what it was and stops.
[[noreturn]] void Finding(const std::string& what);

// Runs a reader. An exception that is none of std's, or whose text does not have `named` (the file's path), is a
// finding.
void Hold(const std::string& named, const std::function<void()>& read);

// The same for a reader of text, which knows no file: only E may be thrown.
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
