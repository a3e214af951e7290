// Purpose: what one run of an odometry leaves behind (docs/result_folder.md): kept as it runs, written at the end.
// Memory is
//          one estimate per frame; pictures go to disk at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/evaluation/estimate_run.h"
#include "tools/report/pictures.h"
#include "vo/odometry.h"

namespace vobench {

// Whether frame `index` of so many is kept as a picture: some two dozen, evenly spread.
bool IsKept(std::int64_t index, std::int64_t frames);

std::vector<report::FeatureMark> MarksOf(const std::vector<vo::FeatureView>& features);

class Recorder {
 public:
  // With a folder, those of `frames` frames that IsKept are kept there as pictures; the folder is made. Without one,
  // none.
  Recorder(std::int64_t frames, std::optional<std::filesystem::path> folder);
  // For frames without images.
  explicit Recorder(std::optional<std::filesystem::path> folder);

  // Throws std::runtime_error naming a picture that cannot be written.
  void Add(const vo::Frame& frame, const vo::Estimate& estimate, const std::vector<vo::FeatureView>& features);
  void Add(const vo::Estimate& estimate);

  const evaluation::EstimateRun& run() const { return run_; }

  // estimate.txt, covariance.txt, frames.csv, landmarks.csv and (of frames with images) pictures.json, in the folder
  // given at first. Throws std::runtime_error.
  void Write(const std::vector<vo::MapPoint>& map) const;

 private:
  std::optional<std::filesystem::path> folder_;
  std::int64_t frames_ = 0;
  report::KeptPictures pictures_;
  evaluation::EstimateRun run_;
};

}  // namespace vobench
