#include "sim/world/importer_files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <fstream>
#include <memory>
#include <stdexcept>

// The address and the thread sanitizer reserve terabytes.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VOBENCH_NO_MEMORY_LIMIT
#elif defined(__has_feature)  // clang's way to ask
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VOBENCH_NO_MEMORY_LIMIT
#endif
#endif

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr rlim_t kSeconds = 5, kSecondsPerMegabyte = 10;
#if defined(VOBENCH_NO_MEMORY_LIMIT)
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif
constexpr rlim_t kMemory = rlim_t{512} << 20, kMemoryPerByte = 64;

// A soft limit, no higher than what the system allows.
void Limit(__rlimit_resource what, rlim_t most) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  limit.rlim_cur = std::min(most, limit.rlim_max);
  setrlimit(what, &limit);
}

// Of the address space that is taken already, which is the parent's.
rlim_t AddressSpace() {
  std::ifstream stream("/proc/self/statm");
  rlim_t pages = 0;
  stream >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void LimitProcess(std::uint64_t bytes, rlim_t taken) {
  Limit(RLIMIT_CPU, kSeconds + kSecondsPerMegabyte * (bytes / 1'000'000));
  if (kLimitMemory) Limit(RLIMIT_AS, taken + kMemory + kMemoryPerByte * bytes);
}

// A file that cannot be read past its end for ever: assimp's PLY importer (5.2) does so when a header is cut off.
class BoundedStream : public Assimp::IOStream {
 public:
  explicit BoundedStream(std::unique_ptr<Assimp::IOStream> stream) : stream_(std::move(stream)) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t read = stream_->Read(buffer, size, count);
    constexpr int kPatience = 1000;
    if (read == 0 && ++empty_reads_ > kPatience) throw std::runtime_error("the file ends too early");
    return read;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override { return stream_->Seek(offset, origin); }
  std::size_t Tell() const override { return stream_->Tell(); }
  std::size_t FileSize() const override { return stream_->FileSize(); }
  void Flush() override {}

 private:
  std::unique_ptr<Assimp::IOStream> stream_;
  int empty_reads_ = 0;
};

// Links followed, both ways.
bool IsBelow(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path top = fs::weakly_canonical(folder.empty() ? "." : folder, error),
                 real = fs::weakly_canonical(file, error);
  if (error) return false;
  return std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

}  // namespace

void SilenceProcess() {
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, output);
  Limit(RLIMIT_CORE, 0);
}

bool LiesBeside(const fs::path& mesh, const fs::path& file) {
  std::error_code error;
  return IsBelow(mesh.parent_path(), file) || IsBelow(fs::weakly_canonical(mesh, error).parent_path(), file);
}

ImporterFiles::ImporterFiles(const fs::path& mesh) : mesh_(mesh), taken_(AddressSpace()) { LimitProcess(0, taken_); }

bool ImporterFiles::MayOpen(const fs::path& file) const {
  std::error_code error;
  return fs::is_regular_file(file, error) && (file == mesh_ || LiesBeside(mesh_, file));
}

bool ImporterFiles::Exists(const char* file) const { return MayOpen(file); }

Assimp::IOStream* ImporterFiles::Open(const char* file, const char* mode) {
  const bool is_new = all_.insert(file).second;
  std::unique_ptr<Assimp::IOStream> stream(mode[0] == 'r' && MayOpen(file) ? DefaultIOSystem::Open(file, mode)
                                                                           : nullptr);
  if (stream == nullptr) {
    missing_.insert(fs::path(file).filename().string());
    return nullptr;
  }
  if (is_new) bytes_ += stream->FileSize();
  LimitProcess(bytes_, taken_);
  return new BoundedStream(std::move(stream));  // Close() deletes it
}

}  // namespace sim
