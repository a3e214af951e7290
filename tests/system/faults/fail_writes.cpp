// Library for LD_PRELOAD: counts the writing calls below a folder over all processes of a program; the n-th call fails.
//
//   VOBENCH_FAULT_FOLDER   absolute; calls on files and folders below it are counted
//   VOBENCH_FAULT_COUNTER  a file of 8 bytes, shared by the processes: number of calls so far
//   VOBENCH_FAULT_LOG      optional: a line "NUMBER CALL PATH" for each
//   VOBENCH_FAULT_AT       number of the call that fails, from 1; 0 for none
//   VOBENCH_FAULT_KIND     ENOSPC, EIO, EINTR or short (half of the bytes are written); ignored by a call that cannot
//                          have it
//
// Counted: open and creat for writing, fopen, write, pwrite, writev, fwrite, fflush, close, fclose, fsync, rename,
// link, mkdir, ftruncate, fallocate, copy_file_range, sendfile, under all their names in the C library.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>

namespace {

constexpr int kStdioError = 0x20;  // _IO_ERR_SEEN of glibc's FILE: tested by ferror()

enum class Fault { none, error, cut };

struct Plan {
  std::string folder;
  std::uint64_t at = 0;
  int error = 0;  // 0: a short write
  int log = -1;
  std::atomic<std::uint64_t>* count = nullptr;
};

Plan MakePlan() {
  Plan plan;
  const auto word = [](const char* name) { return getenv(name) == nullptr ? "" : getenv(name); };
  plan.folder = word("VOBENCH_FAULT_FOLDER");
  plan.at = strtoull(word("VOBENCH_FAULT_AT"), nullptr, 10);
  const std::string kind = word("VOBENCH_FAULT_KIND");
  plan.error = kind == "ENOSPC" ? ENOSPC : kind == "EIO" ? EIO : kind == "EINTR" ? EINTR : 0;
  // Direct system calls: the functions below must not count them.
  const auto file = [](const char* path, int flags) {
    return *path == 0 ? -1 : static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags | O_CLOEXEC, 0666));
  };
  plan.log = file(word("VOBENCH_FAULT_LOG"), O_WRONLY | O_CREAT | O_APPEND);
  const int counter = file(word("VOBENCH_FAULT_COUNTER"), O_RDWR);
  if (counter >= 0) {
    void* page = mmap(nullptr, sizeof *plan.count, PROT_READ | PROT_WRITE, MAP_SHARED, counter, 0);
    if (page != MAP_FAILED) plan.count = static_cast<std::atomic<std::uint64_t>*>(page);
    syscall(SYS_close, counter);
  }
  return plan;
}

const Plan& ThePlan() {
  static const Plan plan = MakePlan();
  return plan;
}

bool IsBelow(std::string_view path) {
  const std::string& folder = ThePlan().folder;
  return ThePlan().count != nullptr && !folder.empty() && path.starts_with(folder) &&
         (path.size() == folder.size() || path[folder.size()] == '/');
}

std::string PathOf(int file) {
  char link[40], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path);
  return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : "";
}

std::string PathOf(int folder, const char* path) {
  if (path == nullptr || *path == '/') return path == nullptr ? "" : path;
  char here[4096];
  const std::string from = folder != AT_FDCWD ? PathOf(folder) : getcwd(here, sizeof here) != nullptr ? here : "";
  return from + "/" + path;
}

// Counts a call. Returns its fault; sets errno for an error.
Fault Next(const char* call, const std::string& path, bool can_be_interrupted, bool can_be_cut = false) {
  if (!IsBelow(path)) return Fault::none;
  const Plan& plan = ThePlan();
  const std::uint64_t number = ++*plan.count;
  if (plan.log >= 0) {
    const std::string line = std::to_string(number) + " " + call + " " + path + "\n";
    syscall(SYS_write, plan.log, line.data(), line.size());
  }
  if (number != plan.at) return Fault::none;
  if (plan.error == 0) return can_be_cut ? Fault::cut : Fault::none;
  if (plan.error == EINTR && !can_be_interrupted) return Fault::none;
  errno = plan.error;
  return Fault::error;
}

template <class Function>
Function Real(const char* name, Function /*type*/) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool Writes(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0; }
bool Writes(const char* mode) { return strpbrk(mode, "wa+") != nullptr; }

std::size_t Half(std::size_t size) { return std::max<std::size_t>(1, size / 2); }

}  // namespace

// Function of the same name and type in the C library.
#define REAL(name) static const auto real = Real(#name, &name)

extern "C" {

#define OPEN(name)                                                                             \
  int name(const char* path, int flags, ...) {                                                 \
    REAL(name);                                                                                \
    va_list more;                                                                              \
    va_start(more, flags);                                                                     \
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;       \
    va_end(more);                                                                              \
    if (Writes(flags) && Next(#name, PathOf(AT_FDCWD, path), true) == Fault::error) return -1; \
    return real(path, flags, mode);                                                            \
  }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                                         \
  int name(int folder, const char* path, int flags, ...) {                                   \
    REAL(name);                                                                              \
    va_list more;                                                                            \
    va_start(more, flags);                                                                   \
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;     \
    va_end(more);                                                                            \
    if (Writes(flags) && Next(#name, PathOf(folder, path), true) == Fault::error) return -1; \
    return real(folder, path, flags, mode);                                                  \
  }
OPENAT(openat)
OPENAT(openat64)

#define CREAT(name)                                                           \
  int name(const char* path, mode_t mode) {                                   \
    REAL(name);                                                               \
    if (Next(#name, PathOf(AT_FDCWD, path), true) == Fault::error) return -1; \
    return real(path, mode);                                                  \
  }
CREAT(creat)
CREAT(creat64)

#define FOPEN(name)                                                                                \
  FILE* name(const char* path, const char* mode) {                                                 \
    REAL(name);                                                                                    \
    if (Writes(mode) && Next(#name, PathOf(AT_FDCWD, path), true) == Fault::error) return nullptr; \
    return real(path, mode);                                                                       \
  }
FOPEN(fopen)
FOPEN(fopen64)

ssize_t write(int file, const void* bytes, size_t size) {
  REAL(write);
  const Fault fault = Next("write", PathOf(file), true, size > 1);
  if (fault == Fault::error) return -1;
  return real(file, bytes, fault == Fault::cut ? Half(size) : size);
}

#define PWRITE(name, offset_type)                                              \
  ssize_t name(int file, const void* bytes, size_t size, offset_type offset) { \
    REAL(name);                                                                \
    const Fault fault = Next(#name, PathOf(file), true, size > 1);             \
    if (fault == Fault::error) return -1;                                      \
    return real(file, bytes, fault == Fault::cut ? Half(size) : size, offset); \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

ssize_t writev(int file, const iovec* parts, int count) {
  REAL(writev);
  const Fault fault = Next("writev", PathOf(file), true, true);
  if (fault == Fault::error) return -1;
  if (fault == Fault::none) return real(file, parts, count);
  const iovec first = {parts[0].iov_base, Half(parts[0].iov_len)};
  return real(file, &first, 1);
}

// stdio itself writes the rest of a short write, and does not repeat an interrupted one.
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
  REAL(fwrite);
  if (Next("fwrite", PathOf(fileno(stream)), true) == Fault::error) {
    stream->_flags |= kStdioError;
    return 0;
  }
  return real(bytes, size, count, stream);
}

int fflush(FILE* stream) {
  REAL(fflush);
  if (stream != nullptr && Next("fflush", PathOf(fileno(stream)), true) == Fault::error) {
    stream->_flags |= kStdioError;
    return EOF;
  }
  return real(stream);
}

int fclose(FILE* stream) {
  REAL(fclose);
  const std::string path = (fcntl(fileno(stream), F_GETFL) & O_ACCMODE) == O_RDONLY ? "" : PathOf(fileno(stream));
  const Fault fault = Next("fclose", path, true);
  const int error = errno, closed = real(stream);
  if (fault != Fault::error) return closed;
  errno = error;
  return EOF;
}

// As on Linux: the file is closed in any case.
int close(int file) {
  REAL(close);
  const int flags = fcntl(file, F_GETFL);
  const bool is_writable = flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
  const Fault fault = is_writable ? Next("close", PathOf(file), true) : Fault::none;
  const int error = errno, closed = real(file);
  if (fault != Fault::error) return closed;
  errno = error;
  return -1;
}

#define ON_FILE(name, interrupted)                                                   \
  int name(int file) {                                                               \
    REAL(name);                                                                      \
    return Next(#name, PathOf(file), interrupted) == Fault::error ? -1 : real(file); \
  }
ON_FILE(fsync, true)
ON_FILE(fdatasync, true)

#define CUT(name, offset_type)                                                      \
  int name(int file, offset_type size) noexcept {                                   \
    REAL(name);                                                                     \
    return Next(#name, PathOf(file), true) == Fault::error ? -1 : real(file, size); \
  }
CUT(ftruncate, off_t)
CUT(ftruncate64, off64_t)

int fallocate(int file, int mode, off_t offset, off_t size) {
  REAL(fallocate);
  return Next("fallocate", PathOf(file), true) == Fault::error ? -1 : real(file, mode, offset, size);
}

int posix_fallocate(int file, off_t offset, off_t size) {
  REAL(posix_fallocate);
  return Next("posix_fallocate", PathOf(file), true) == Fault::error ? errno : real(file, offset, size);
}

int rename(const char* from, const char* to) noexcept {
  REAL(rename);
  return Next("rename", PathOf(AT_FDCWD, to), false) == Fault::error ? -1 : real(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  REAL(renameat);
  return Next("renameat", PathOf(to_folder, to), false) == Fault::error ? -1 : real(from_folder, from, to_folder, to);
}

int link(const char* from, const char* to) noexcept {
  REAL(link);
  return Next("link", PathOf(AT_FDCWD, to), false) == Fault::error ? -1 : real(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
  REAL(mkdir);
  return Next("mkdir", PathOf(AT_FDCWD, path), false) == Fault::error ? -1 : real(path, mode);
}

int mkdirat(int folder, const char* path, mode_t mode) noexcept {
  REAL(mkdirat);
  return Next("mkdirat", PathOf(folder, path), false) == Fault::error ? -1 : real(folder, path, mode);
}

ssize_t copy_file_range(int from, off64_t* from_at, int to, off64_t* to_at, size_t size, unsigned flags) {
  REAL(copy_file_range);
  const Fault fault = Next("copy_file_range", PathOf(to), true, size > 1);
  if (fault == Fault::error) return -1;
  return real(from, from_at, to, to_at, fault == Fault::cut ? Half(size) : size, flags);
}

#define SENDFILE(name, offset_type)                                           \
  ssize_t name(int to, int from, offset_type* offset, size_t size) noexcept { \
    REAL(name);                                                               \
    const Fault fault = Next(#name, PathOf(to), true, size > 1);              \
    if (fault == Fault::error) return -1;                                     \
    return real(to, from, offset, fault == Fault::cut ? Half(size) : size);   \
  }
SENDFILE(sendfile, off_t)
SENDFILE(sendfile64, off64_t)

}  // extern "C"
