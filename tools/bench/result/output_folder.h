// Output folder written under a temporary name beside its final one and renamed when complete; removed if the work
// stops before.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace vobench {

class OutputFolder {
 public:
  // May replace an existing folder only if that is empty, or is one of ours: it has the file `marker`, and at its top
  // level nothing but the names in `ours`. Throws BadInput naming what is in the way, std::runtime_error when the
  // temporary folder cannot be made.
  OutputFolder(const std::filesystem::path& final_path, const std::string& marker, const std::set<std::string>& ours);
  // Removes what was not committed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // Where to write until Commit.
  const std::filesystem::path& path() const { return temporary_; }
  const std::filesystem::path& final_path() const { return final_; }

  // Gives the folder its final name; one that was there goes. Throws std::runtime_error, leaving the old one in place.
  void Commit();

 private:
  void Discard();

  std::filesystem::path final_;
  std::filesystem::path temporary_;
  std::vector<std::filesystem::path> made_parents_;  // outermost first
  bool committed_ = false;
};

// Gives the folder `from` the name `to`, beside it; one that was there goes. Throws std::runtime_error, leaving the old
// one in place.
void ReplaceFolder(const std::filesystem::path& from, const std::filesystem::path& to);

// "out/demo/" and "out/./demo" name the same folder: .../out/demo.
std::filesystem::path CleanPath(const std::filesystem::path& path);

// Throws BadInput where there is something else than a folder, a link to nothing too.
void RequireFolderIfThere(const std::filesystem::path& path);

// Throws BadInput unless `folder` is absent, empty or one of ours, as above. For checking before long work.
void RequireReplaceable(const std::filesystem::path& folder, const std::string& marker,
                        const std::set<std::string>& ours);

}  // namespace vobench
