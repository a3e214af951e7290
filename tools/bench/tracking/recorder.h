// Record of one run of an odometry, filled frame by frame. With a folder its memory is bounded: estimates are kept in a
// file there (DiskBackedSeries), pictures are written at once.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/bench/result/result.h"
#include "tools/bench/tracking/disk_backed_series.h"
#include "tools/judge/evaluation/estimate_run.h"
#include "vo/base/result.h"
#include "vo/base/source.h"

namespace vobench {

// Whether frame `index` of so many is kept as a picture: some two dozen, evenly spread.
bool IsKept(std::int64_t index, std::int64_t frames);

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
  // Poses of the first frames, one each, for the trajectory: the answers stay as they are. None changes nothing.
  void Reissue(const std::vector<vo::StampedPose>& poses);

  std::size_t frames() const { return answers_.size(); }
  // All answers so far. Throws std::runtime_error.
  evaluation::EstimateRun Run() const;
  // The same with the map and which frames have pictures, as the result folder keeps it.
  RunData Result(const RunEntry& entry, const std::vector<vo::MapPoint>& map) const;

 private:
  // Answer of one frame: its data in live.txt, covariance.txt and frames.csv.
  struct Answer {
    std::int64_t stamp_ns;
    std::array<double, 3> p_WC;
    std::array<double, 4> q_WC;  // x y z w
    std::array<double, 3> v_WC, w_WC_C;
    std::array<double, 144> covariance;
    evaluation::FrameRecord frame;
  };

  std::optional<std::filesystem::path> folder_;
  std::int64_t expected_frames_ = 0;
  KeptPictures pictures_;
  DiskBackedSeries<Answer> answers_;
  std::vector<vo::StampedPose> reissued_;
};

}  // namespace vobench
