// Purpose: what one run of an odometry leaves behind (docs/result_folder.md): kept as it runs, written at the end.
// Memory is
//          one estimate per frame; pictures go to disk at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/evaluation/estimate_run.h"
#include "vo/odometry.h"

namespace vobench {

class Recorder {
 public:
  // With a folder, about ten of `frames` frames are kept there as pictures; the folder is made. Without one, none.
  Recorder(std::int64_t frames, std::optional<std::filesystem::path> folder);
  // For frames without images.
  explicit Recorder(std::optional<std::filesystem::path> folder);

  // Throws std::runtime_error naming a picture that cannot be written.
  void Add(const vo::Frame& frame, const vo::Estimate& estimate, const std::vector<vo::FeatureView>& features);
  void Add(const vo::Estimate& estimate);

  const evaluation::EstimateRun& run() const { return run_; }

  // estimate.txt, covariance.txt, frames.csv and landmarks.csv, in the folder given at first. Throws
  // std::runtime_error.
  void Write(const std::vector<vo::MapPoint>& map) const;

 private:
  std::optional<std::filesystem::path> folder_;
  std::int64_t picture_every_ = 1;
  std::int64_t added_ = 0;
  evaluation::EstimateRun run_;
};

}  // namespace vobench
