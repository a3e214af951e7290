// File access and resource limits of the import process. Private to sim/world.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace sim {

// Silences the calling process: no output, no core file.
void SilenceProcess();

// Whether `file`, links followed, lies in the mesh's folder or deeper. A mesh that is itself a link has two: where it
// is named, and where it leads.
bool LiesBeside(const std::filesystem::path& mesh, const std::filesystem::path& file);

// Opens regular files below the mesh's folder, and nothing else; importers quietly do without a side file (an OBJ's
// materials, say) that cannot be opened. From the first one on, the calling process has the limits of ImportMesh; each
// file that is opened widens them.
class ImporterFiles : public Assimp::DefaultIOSystem {
 public:
  explicit ImporterFiles(const std::filesystem::path& mesh);
  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;

  const std::set<std::filesystem::path>& all() const { return all_; }  // that were looked for
  const std::set<std::string>& missing() const { return missing_; }

 private:
  bool MayOpen(const std::filesystem::path& file) const;

  std::filesystem::path mesh_;
  std::set<std::filesystem::path> all_;
  std::set<std::string> missing_;
  std::uint64_t bytes_ = 0;  // of all files that were opened
  std::uint64_t taken_;      // of the address space, before the first one [bytes]
};

}  // namespace sim
