#include "tests/fuzz/hold.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "tests/temporary_folder.h"

namespace fuzz {
namespace fs = std::filesystem;

const fs::path& Folder() {
  static const auto own = [] {
    std::error_code error;
    const fs::path in_memory = "/dev/shm";
    const bool there = fs::is_directory(in_memory, error) && access(in_memory.c_str(), W_OK) == 0;
    auto folder = std::make_unique<vobench_test::TemporaryFolder>(there ? in_memory : fs::temp_directory_path());
    fs::current_path(folder->path());
    return folder;
  }();
  return own->path();
}

InputFile::InputFile(const std::string& name) : path_(name) {
  fs::create_directories((Folder() / name).parent_path());
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file_ < 0) throw std::runtime_error("cannot open " + path_.string());
}

InputFile::~InputFile() { close(file_); }

void InputFile::Write(Bytes bytes) {
  const auto size = static_cast<ssize_t>(bytes.size());
  if (pwrite(file_, bytes.data(), bytes.size(), 0) != size || ftruncate(file_, size) != 0)
    throw std::runtime_error("cannot write " + path_.string());
}

void WriteBeside(const std::string& name, const std::string& content) {
  const fs::path path = Folder() / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
}

void Finding(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

void Hold(const std::string& named, const std::function<void()>& read) {
  try {
    read();
  } catch (const std::exception& error) {
    const std::string text = error.what();
    if (text.find(named) == std::string::npos) Finding("a message that does not name " + named + ": " + text);
  }
}

}  // namespace fuzz
