#include "sim/world/mesh_import.h"

#include <assimp/postprocess.h>
#include <string.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "sim/world/importer_files.h"
#include "sim/world/mesh_serialization.h"
#include "tools/base/child_process.h"

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

std::string WhyItEnded(const base::ExitStatus& end, bool in_time) {
  if (!in_time) return "the importer (assimp) took longer than " + std::to_string(kPatience.count()) + " s";
  if (end.signal == SIGXCPU) return "the importer (assimp) took longer than a file of this size may";
  if (end.signal != 0)
    return std::string("the importer (assimp) crashed on it: ") + strsignal(end.signal) +
           "; the file is damaged, or of a kind that it cannot read";
  return "the importer (assimp) gave up on it";
}

base::ChildProcess StartImporter(const fs::path& file) {
  try {
    return base::ChildProcess([&](int answer) {
      SilenceProcess();
      return base::WriteAll(answer, base::AsText(Import(file)));
    });
  } catch (const std::system_error& error) {
    throw std::runtime_error(file.string() + ": no importer: " + error.what());
  }
}

}  // namespace

MeshImport ImportMesh(const fs::path& file) {
  const base::ChildProcess importer = StartImporter(file);
  const std::optional<std::string> answer = importer.ReadAnswer(std::chrono::steady_clock::now() + kPatience);
  if (!answer) importer.Kill();
  const base::ExitStatus end = importer.Wait();
  MeshImport import;
  if (answer && end.signal == 0 && end.status == 0) {
    try {
      return FromAnswer(base::AsBytes(*answer));
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
