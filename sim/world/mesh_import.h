// Import of a mesh file in a child process, by a reader made for its format or by assimp: limits on time, memory and
// counts, no files outside the allowed folders. Private to sim/world.
// Source: docs/reliability.md, "Hostile input".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/imported_scene.h"

namespace sim {

// Whether `file`, links followed, lies in the mesh's folder, in one of `folders`, or deeper. A mesh that is itself a
// link has two folders: where it is named, and where it leads.
bool IsAllowed(const std::filesystem::path& mesh, const std::vector<std::filesystem::path>& folders,
               const std::filesystem::path& file);

// File access of a mesh reader: regular files in the allowed folders only. The calling process has the limits of
// ImportMesh; each opened file raises them.
class MeshFiles {
 public:
  // import: receives the names of the files looked for and of those missing.
  MeshFiles(std::filesystem::path mesh, const std::vector<std::filesystem::path>& folders, MeshImport& import);

  const std::filesystem::path& mesh() const { return mesh_; }
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  bool MayOpen(const std::filesystem::path& file) const;
  // None where the file is not allowed or cannot be opened.
  std::optional<std::string> Read(const std::filesystem::path& file);
  void Opened(const std::filesystem::path& file, std::uint64_t bytes);
  void Missing(const std::filesystem::path& file);

 private:
  std::filesystem::path mesh_;
  const std::vector<std::filesystem::path>& folders_;
  MeshImport& import_;
  std::uint64_t bytes_ = 0;  // of all files that were opened
  std::uint64_t taken_;      // of the address space, before the first one [bytes]
};

// Limits: processor time, five seconds and ten more for each MB of the opened files; memory, 512 MiB and 64 bytes for
// each of their bytes. An importer that crashes or exceeds a limit is a problem with the file like any other.
// Throws std::runtime_error where no process can be started.
// only_cameras: no mesh of a glTF file is read.
MeshImport ImportMesh(const std::filesystem::path& file, const std::vector<std::filesystem::path>& folders,
                      bool only_cameras = false);

}  // namespace sim
