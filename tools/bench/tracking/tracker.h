// One odometry with the record of its run: on image frames, or on a world of points with known identity.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/result/run_json.h"
#include "tools/bench/tracking/recorder.h"
#include "vo/odometry.h"
#include "vo/point_odometry.h"

namespace vobench {

// System, parameters and seed of a tracker.
struct TrackerSetup {
  std::string system;
  std::uint64_t seed = 1;
  vo::Params params;
  vo::Prior prior;
};

// Common part of both kinds.
template <class Odometry>
class RecordedOdometry {
 public:
  // All of it, to be written and drawn. Throws std::runtime_error.
  RunData Result(const std::vector<vo::MapPoint>& map) const { return recorder_.Result(entry_, map); }

  std::vector<vo::MapPoint> map() const { return odometry_.Map(); }
  const RunEntry& entry() const { return entry_; }
  std::size_t frames() const { return recorder_.frames(); }
  evaluation::EstimateRun Estimates() const { return recorder_.Run(); }  // all of them, read from the spool

 protected:
  RecordedOdometry(const TrackerSetup& setup, const vo::Camera& camera, const std::string& folder, Recorder recorder);

  RunEntry entry_;
  Odometry odometry_;
  Recorder recorder_;
};

class Tracker : public RecordedOdometry<vo::Odometry> {
 public:
  // `folder`, if any, is the run folder of the finished run inside `out`: pictures go there on the way. Throws
  // BadInput.
  Tracker(const TrackerSetup& setup, const vo::Camera& camera, std::int64_t frames,
          const std::optional<std::filesystem::path>& out, const std::string& folder);

  // Throws BadInput when the frame does not fit the camera, or time decreases: nothing has changed then. Throws
  // vo::FilterFault: the record so far is valid, the map is not.
  void Track(const vo::Frame& frame) { Track(vo::PreparedFrame(frame)); }
  void Track(const vo::PreparedFrame& prepared);

  RunData Result(const std::vector<vo::MapPoint>& map) const;
  // Of all frames; none where it is not estimated. Completes the fit of a window, which is otherwise spread over
  // frames.
  std::optional<CalibrationRecord> calibration() const;
  // Of the last frame.
  const std::vector<vo::FeatureView>& features() const { return odometry_.Features(); }

 private:
  double focal_px_;  // as stated
};

class PointTracker : public RecordedOdometry<vo::PointOdometry> {
 public:
  // As of Tracker.
  PointTracker(const TrackerSetup& setup, const vo::Camera& camera, const std::optional<std::filesystem::path>& out,
               const std::string& folder);

  vo::Estimate Track(const vo::PointFrame& frame);
  // Mixture whose moments are the last estimate.
  const std::vector<vo::BeliefComponent>& mixture() const { return odometry_.Mixture(); }
};

}  // namespace vobench
