#include "sim/world/mesh_import.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <fcntl.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "sim/world/gltf_file.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/mesh_serialization.h"
#include "sim/world/texture_file.h"
#include "tools/base/child_process.h"
#include "tools/base/files.h"

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

// Importers quietly do without a side file that cannot be opened.
class ImporterFiles : public Assimp::DefaultIOSystem {
 public:
  explicit ImporterFiles(MeshFiles& files) : files_(files) {}
  bool Exists(const char* file) const override { return files_.MayOpen(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    std::unique_ptr<Assimp::IOStream> stream(mode[0] == 'r' && files_.MayOpen(file) ? DefaultIOSystem::Open(file, mode)
                                                                                    : nullptr);
    if (stream == nullptr) {
      files_.Missing(file);
      return nullptr;
    }
    files_.Opened(file, stream->FileSize());
    if (LowerExtension(file) == ".dae") return WithoutBlanks(file);
    return new BoundedStream(std::move(stream));  // Close() deletes it
  }

 private:
  // Blanks at the beginning of an element's text, which assimp (5.2) takes for the end of its numbers.
  static Assimp::IOStream* WithoutBlanks(const fs::path& file) {
    const std::string text = base::ReadFile(file).value_or("");
    auto* bytes = new std::uint8_t[text.size() + 1];
    std::size_t size = 0;
    bool skips = false;
    for (const char c : text) {
      skips = c == '>' || (skips && std::isspace(static_cast<unsigned char>(c)) != 0);
      if (!skips || c == '>') bytes[size++] = static_cast<std::uint8_t>(c);
    }
    return new Assimp::MemoryIOStream(bytes, size, true);  // owns them
  }

  MeshFiles& files_;
};

// No output, no core file.
void SilenceProcess() {
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, output);
  Limit(RLIMIT_CORE, 0);
}

constexpr std::chrono::seconds kPatience(600);  // of whoever waits: an importer that sleeps uses no processor

// FBX states its unit in centimetres and its axes; assimp (5.2) leaves both to whoever reads.
void ApplyFbxSettings(aiScene& scene) {
  double unit = 1;
  int axis[3] = {0, 1, 2}, sign[3] = {1, 1, 1};  // of what becomes x, y, z
  if (scene.mMetaData != nullptr) {
    float single = 1;
    if (!scene.mMetaData->Get("UnitScaleFactor", unit) && scene.mMetaData->Get("UnitScaleFactor", single))
      unit = single;
    constexpr const char* kNames[] = {"CoordAxis", "UpAxis", "FrontAxis"};
    for (int i = 0; i < 3; ++i) {
      scene.mMetaData->Get(kNames[i], axis[i]);
      scene.mMetaData->Get(std::string(kNames[i]) + "Sign", sign[i]);
    }
  }
  const bool is_permutation = std::set<int>(axis, axis + 3) == std::set<int>{0, 1, 2};
  aiMatrix4x4 to_metres;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column) {
      const bool here = is_permutation ? axis[row] == static_cast<int>(column) : row == column;
      to_metres[row][column] =
          here ? static_cast<float>(0.01 * unit * (is_permutation && sign[row] < 0 ? -1 : 1)) : 0.0f;
    }
  }
  if (scene.mRootNode != nullptr && unit > 0)
    scene.mRootNode->mTransformation = to_metres * scene.mRootNode->mTransformation;
}

void ImportByAssimp(MeshFiles& files, MeshImport& import) {
  Assimp::Importer importer;
  importer.SetIOHandler(new ImporterFiles(files));  // the importer owns it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(files.mesh().string(), aiProcess_ValidateDataStructure);
  if (scene != nullptr) import.problem = MeshCountProblem(*scene);  // what is too large is not worked on
  if (scene != nullptr && import.problem.empty()) {
    scene =
        importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType);
    if (scene != nullptr) import.problem = MeshCountProblem(*scene);
  }
  if (scene == nullptr) {
    const std::string reason = importer.GetErrorString();
    const bool only_lines = reason.find("No meshes remaining") != std::string::npos;  // the importer's words for it
    const bool too_much = reason.find("bad_alloc") != std::string::npos;              // the library's
    import.problem = only_lines ? "has no triangles"
                     : too_much ? "cannot be read: the importer (assimp) wants more memory than a file of this size may"
                                : "cannot be read: " + reason;
  }
  if (!import.problem.empty()) return;
  import.scene.reset(importer.GetOrphanedScene());
  if (LowerExtension(files.mesh()) == ".fbx") ApplyFbxSettings(*import.scene);
}

std::vector<std::uint8_t> Import(const fs::path& file, const std::vector<fs::path>& folders) {
  MeshImport import;
  MeshFiles files(file, folders, import);
  const std::string extension = LowerExtension(file);
  const std::map<std::string_view, void (*)(MeshFiles&, MeshImport&)> readers = {
      {".obj", ReadObj}, {".ply", ReadPly}, {".gltf", ReadGltf}, {".glb", ReadGltf}};
  const auto read = readers.find(extension);
  try {
    (read == readers.end() ? ImportByAssimp : read->second)(files, import);
    if (import.problem.empty() && import.scene != nullptr) import.problem = MeshCountProblem(*import.scene);
  } catch (const OlderGltf&) {
    ImportByAssimp(files, import);
  } catch (const std::bad_alloc&) {
    import.problem = "cannot be read: it wants more memory than a file of this size may";
  }
  return ToBytes(import);
}

std::string WhyItEnded(const base::ExitStatus& end, bool in_time) {
  if (!in_time) return "the importer took longer than " + std::to_string(kPatience.count()) + " s";
  if (end.signal == SIGXCPU) return "the importer took longer than a file of this size may";
  if (end.signal != 0)
    return std::string("the importer crashed on it: ") + strsignal(end.signal) +
           "; the file is damaged, or of a kind that it cannot read";
  return "the importer gave up on it";
}

base::ChildProcess StartImporter(const fs::path& file, const std::vector<fs::path>& folders) {
  try {
    return base::ChildProcess([&](int answer) {
      SilenceProcess();
      return base::WriteAll(answer, base::AsText(Import(file, folders)));
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

MeshImport ImportMesh(const fs::path& file, const std::vector<fs::path>& folders) {
  const base::ChildProcess importer = StartImporter(file, folders);
  const std::optional<std::string> answer = importer.ReadAnswer(std::chrono::steady_clock::now() + kPatience);
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
