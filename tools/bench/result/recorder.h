// Purpose: what one run of an odometry leaves behind (docs/result_folder.md): kept as it runs, written at the end. In a folder, memory
//          is the same however long it runs: answers are spooled there, pictures go there at once.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/bench/report/pictures.h"
#include "tools/bench/result/spool.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "vo/odometry.h"

namespace vobench {

// Whether frame `index` of so many is kept as a picture: some two dozen, evenly spread.
bool IsKept(std::int64_t index, std::int64_t frames);

std::vector<report::FeatureMark> MarksOf(const std::vector<vo::FeatureView>& features);

class Recorder {
 public:
  // With a folder, those of `frames` frames that IsKept are kept there as pictures; the folder is made. Without one,
  // none, and all answers are in memory (1.4 kB each).
  Recorder(std::int64_t frames, std::optional<std::filesystem::path> folder);
  // For frames without images.
  explicit Recorder(std::optional<std::filesystem::path> folder);

  // Throws std::runtime_error naming a picture, or the folder of the spool, that cannot be written.
  void Add(const vo::Frame& frame, const vo::Estimate& estimate, const std::vector<vo::FeatureView>& features);
  void Add(const vo::Estimate& estimate);

  std::size_t frames() const { return answers_.size(); }
  // All answers so far. Throws std::runtime_error.
  evaluation::EstimateRun Run() const;

  // estimate.txt, covariance.txt, frames.csv, landmarks.csv and (of frames with images) pictures.json, in the folder
  // given at first. Throws std::runtime_error.
  void Write(const std::vector<vo::MapPoint>& map) const;

 private:
  // One frame's: what estimate.txt, covariance.txt and frames.csv say of it.
  struct Answer {
    std::int64_t stamp_ns;
    std::array<double, 3> p_WC;
    std::array<double, 4> q_WC;  // x y z w
    std::array<double, 3> v_WC, w_WC_C;
    std::array<double, 144> covariance;
    evaluation::FrameRecord frame;
  };
  static Answer AnswerOf(const vo::Estimate& estimate);

  std::optional<std::filesystem::path> folder_;
  std::int64_t expected_frames_ = 0;
  report::KeptPictures pictures_;
  Spool<Answer> answers_;
};

}  // namespace vobench
