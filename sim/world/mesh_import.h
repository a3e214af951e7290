// Import of a mesh file by assimp in a child process: limits on time, memory and counts, no files outside the folder of
// the mesh. Private to sim/world.
// Source: docs/reliability.md, "Hostile input".
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

namespace sim {

struct MeshImport {
  std::unique_ptr<aiScene> scene;         // triangles only; null: see problem
  std::string problem;                    // why there is none
  std::set<std::filesystem::path> files;  // that the importer looked for
  std::set<std::string> missing;          // those that could not be opened, without their folder
};

// Whether `file`, links followed, lies in the mesh's folder or deeper. A mesh that is itself a link has two: where it
// is named, and where it leads.
bool LiesBeside(const std::filesystem::path& mesh, const std::filesystem::path& file);

// Time is the processor's: five seconds, and ten more for each MB of the files that are opened. Memory: 512 MiB, and 64
// bytes for each of theirs. An importer that crashes or runs into a limit is a problem with the file like any other.
// Throws std::runtime_error where no process can be started.
MeshImport ImportMesh(const std::filesystem::path& file);

}  // namespace sim
