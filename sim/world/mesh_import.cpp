#include "sim/world/mesh_import.h"

#include <assimp/postprocess.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/world/importer_files.h"
#include "sim/world/mesh_serialization.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience(600);  // of whoever waits: an importer that sleeps uses no processor

// What the child says: a length and so many bytes, for each of the problem, the files, those that are missing (each
// text ends with a zero), and the scene.
std::vector<std::uint8_t> Answer(const std::string& problem, const ImporterFiles& files, const aiScene* scene) {
  std::vector<std::uint8_t> answer;
  const auto append = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    const std::uint64_t length = size;
    const std::size_t at = answer.size();
    answer.resize(at + sizeof length + size);
    std::copy_n(reinterpret_cast<const std::uint8_t*>(&length), sizeof length, &answer[at]);
    std::copy_n(bytes, size, answer.begin() + static_cast<std::ptrdiff_t>(at + sizeof length));
  };
  append(problem.data(), problem.size());
  std::string names, missing;
  for (const fs::path& file : files.all()) names += file.string() + '\0';
  for (const std::string& file : files.missing()) missing += file + '\0';
  append(names.data(), names.size());
  append(missing.data(), missing.size());
  const std::vector<std::uint8_t> bytes =
      scene != nullptr && problem.empty() ? ToBytes(*scene) : std::vector<std::uint8_t>();
  append(bytes.data(), bytes.size());
  return answer;
}

std::vector<std::uint8_t> Import(const fs::path& file) {
  Assimp::Importer importer;
  auto* files = new ImporterFiles(file);  // the importer owns it
  importer.SetIOHandler(files);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
  // What is too large is not worked on.
  const std::string too_large = scene != nullptr ? MeshCountProblem(*scene) : "";
  if (too_large.empty() && scene != nullptr)
    scene =
        importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType);
  std::string problem = too_large;
  if (scene == nullptr) {
    const std::string reason = importer.GetErrorString();
    const bool only_lines = reason.find("No meshes remaining") != std::string::npos;  // the importer's words for it
    const bool too_much = reason.find("bad_alloc") != std::string::npos;              // the library's
    problem = only_lines ? "has no triangles"
              : too_much ? "cannot be read: the importer (assimp) wants more memory than a file of this size may"
                         : "cannot be read: " + reason;
  } else if (problem.empty()) {
    problem = MeshCountProblem(*scene);
  }
  return Answer(problem, *files, scene);
}

bool WriteAll(int to, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = write(to, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += static_cast<std::size_t>(written);
  }
  return true;
}

// Until the other end is closed, or nobody has the patience.
std::pair<std::vector<std::uint8_t>, bool> ReadAll(int from) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> piece(1 << 16);
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd end{from, POLLIN, 0};
    const int ready = left.count() > 0 ? poll(&end, 1, static_cast<int>(left.count())) : 0;
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return {std::move(bytes), false};
    const ssize_t read = ::read(from, piece.data(), piece.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return {std::move(bytes), read == 0};
    bytes.insert(bytes.end(), piece.begin(), piece.begin() + read);
  }
}

std::vector<std::string> Texts(std::span<const std::uint8_t> bytes) {
  std::vector<std::string> texts;
  for (auto at = bytes.begin(); at != bytes.end();) {
    const auto end = std::find(at, bytes.end(), std::uint8_t{0});
    texts.emplace_back(at, end);
    at = end == bytes.end() ? end : end + 1;
  }
  return texts;
}

MeshImport FromAnswer(std::span<const std::uint8_t> answer) {
  const auto next = [&] {
    std::uint64_t length = 0;
    if (answer.size() < sizeof length) throw std::runtime_error("the importer's answer is broken off");
    std::memcpy(&length, answer.data(), sizeof length);
    answer = answer.subspan(sizeof length);
    if (answer.size() < length) throw std::runtime_error("the importer's answer is broken off");
    const auto part = answer.first(length);
    answer = answer.subspan(length);
    return part;
  };
  MeshImport import;
  const auto problem = next();
  import.problem.assign(problem.begin(), problem.end());
  for (const std::string& file : Texts(next())) import.files.insert(file);
  for (const std::string& file : Texts(next())) import.missing.insert(file);
  const auto scene = next();
  if (import.problem.empty()) import.scene = SceneFromBytes(scene);
  return import;
}

std::string WhyItEnded(int status, bool patient) {
  if (!patient) return "the importer (assimp) took longer than " + std::to_string(kPatience.count()) + " s";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "the importer (assimp) took longer than a file of this size may";
  if (WIFSIGNALED(status))
    return std::string("the importer (assimp) crashed on it: ") + strsignal(WTERMSIG(status)) +
           "; the file is damaged, or of a kind that it cannot read";
  return "the importer (assimp) gave up on it";
}

}  // namespace

MeshImport ImportMesh(const fs::path& file) {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(file.string() + ": no pipe to an importer: " + std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    const std::string why = std::strerror(errno);
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error(file.string() + ": no process for an importer: " + why);
  }
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    bool good = false;
    try {
      close(ends[0]);
      SilenceProcess();
      good = WriteAll(ends[1], Import(file));
    } catch (...) {  // out of memory: the parent is told by the status
    }
    _exit(good ? 0 : 1);
  }
  close(ends[1]);
  const auto [answer, patient] = ReadAll(ends[0]);
  close(ends[0]);
  if (!patient) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  MeshImport import;
  if (patient && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    try {
      return FromAnswer(answer);
    } catch (const std::runtime_error& error) {
      import.problem = error.what();
    }
  } else {
    import.problem = "cannot be read: " + WhyItEnded(status, patient);
  }
  import.files.insert(file);
  return import;
}

}  // namespace sim
