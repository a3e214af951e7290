#include "sim/world/mesh_import.h"

#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "sim/world/gltf_file.h"
#include "sim/world/image_file.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"
#include "tools/base/child_process.h"
#include "tools/base/files.h"
#include "tools/base/text.h"

// The address and the thread sanitizer reserve terabytes.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VOBENCH_NO_MEMORY_LIMIT
#elif defined(__has_feature)  // clang's feature test
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

// Sets a soft limit, at most the system's.
void Limit(__rlimit_resource what, rlim_t most) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  limit.rlim_cur = std::min(most, limit.rlim_max);
  setrlimit(what, &limit);
}

// Address space in use, which is the parent's.
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

// No output, no core file.
void SilenceProcess() {
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, output);
  Limit(RLIMIT_CORE, 0);
}

constexpr std::uintmax_t kMostReserved = std::uintmax_t{1} << 30;  // for an answer [bytes]
constexpr std::chrono::seconds kPatience(600);  // of the waiting process: a sleeping importer uses no processor time

MeshImport Import(const fs::path& file, const std::vector<fs::path>& folders, bool only_cameras) {
  MeshImport import;
  MeshFiles files(file, folders, import);
  const std::string extension = LowerExtension(file);
  const auto gltf = only_cameras ? ReadGltfCameras : ReadGltf;
  const std::map<std::string_view, void (*)(MeshFiles&, MeshImport&)> readers = {
      {".obj", ReadObj}, {".ply", ReadPly}, {".off", ReadOff}, {".stl", ReadStl},
      {".3mf", Read3mf}, {".gltf", gltf},   {".glb", gltf}};
  const auto read = readers.find(extension);
  std::string head(200, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  import.problem = StandInProblem(base::AsBytes(head));
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) import.problem = base::TextProblem(head);
  if (!import.problem.empty()) return import;
  try {
    (read == readers.end() ? ReadByAssimp : read->second)(files, import);
    if (import.problem.empty()) import.problem = CountsOf(import.scene).Problem();
  } catch (const OlderGltf&) {
    ReadByAssimp(files, import);
  } catch (const std::bad_alloc&) {
    import.problem = "cannot be read: it needs more memory than a file of this size may";
  }
  if (!import.problem.empty()) import.scene = {};
  return import;
}

std::string WhyItEnded(const base::ExitStatus& end, bool in_time) {
  if (!in_time) return "the importer took longer than " + std::to_string(kPatience.count()) + " s";
  if (end.signal == SIGXCPU) return "the importer took longer than a file of this size may";
  if (end.signal != 0)
    return std::string("the importer crashed on it: ") + strsignal(end.signal) +
           "; the file is damaged, or of a kind that it cannot read";
  return "the importer gave up on it";
}

base::ChildProcess StartImporter(const fs::path& file, const std::vector<fs::path>& folders, bool only_cameras) {
  try {
    return base::ChildProcess([&](int answer) {
      SilenceProcess();
      int error = 0;
      WriteBytes(Import(file, folders, only_cameras), [&](std::span<const std::uint8_t> bytes) {
        if (error == 0) error = base::WriteAll(answer, base::AsText(bytes));
      });
      return error;
    });
  } catch (const std::system_error& error) {
    throw std::runtime_error(file.string() + ": no importer: " + error.what());
  }
}

// Links followed, both ways.
bool IsBelow(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path top = fs::weakly_canonical(folder.empty() ? "." : folder, error),
                 real = fs::weakly_canonical(file, error);
  if (error) return false;
  return std::mismatch(top.begin(), top.end(), real.begin(), real.end()).first == top.end();
}

}  // namespace

bool IsAllowed(const fs::path& mesh, const std::vector<fs::path>& folders, const fs::path& file) {
  std::error_code error;
  return IsBelow(mesh.parent_path(), file) || IsBelow(fs::weakly_canonical(mesh, error).parent_path(), file) ||
         std::ranges::any_of(folders, [&](const fs::path& folder) { return IsBelow(folder, file); });
}

MeshFiles::MeshFiles(fs::path mesh, const std::vector<fs::path>& folders, MeshImport& import)
    : mesh_(std::move(mesh)), folders_(folders), import_(import), taken_(AddressSpace()) {
  LimitProcess(0, taken_);
}

bool MeshFiles::MayOpen(const fs::path& file) const {
  std::error_code error;
  return fs::is_regular_file(file, error) && (file == mesh_ || IsAllowed(mesh_, folders_, file));
}

std::optional<std::string> MeshFiles::Read(const fs::path& file) {
  if (!MayOpen(file)) {
    import_.files.insert(file);
    return std::nullopt;
  }
  std::error_code error;
  Opened(file, fs::file_size(file, error));
  return base::ReadFile(file);
}

void MeshFiles::Opened(const fs::path& file, std::uint64_t bytes) {
  if (import_.files.insert(file).second) bytes_ += bytes;
  LimitProcess(bytes_, taken_);
}

void MeshFiles::Missing(const fs::path& file) {
  import_.files.insert(file);
  import_.missing.insert(file.filename().string());
}

MeshImport ImportMesh(const fs::path& file, const std::vector<fs::path>& folders, bool only_cameras) {
  const base::ChildProcess importer = StartImporter(file, folders, only_cameras);
  std::error_code unknown;
  const std::uintmax_t size = fs::file_size(file, unknown);
  const std::optional<std::string> answer = importer.ReadAnswer(
      std::chrono::steady_clock::now() + kPatience, unknown ? 0 : std::min<std::uintmax_t>(2 * size, kMostReserved));
  if (!answer) importer.Kill();
  const base::ExitStatus end = importer.Wait();
  MeshImport import;
  if (answer && end.signal == 0 && end.status == 0) {
    try {
      return ImportFromBytes(base::AsBytes(*answer));
    } catch (const std::runtime_error& error) {
      import.problem = error.what();
    }
  } else {
    import.problem = "cannot be read: " + WhyItEnded(end, answer.has_value());
  }
  import.files.insert(file);
  return import;
}

}  // namespace sim
