// Purpose: one odometry at work on a world of points with known identity, with all that must be kept of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/report/run_json.h"
#include "tools/bench/result/recorder.h"
#include "tools/bench/result/tracker.h"
#include "vo/point_odometry.h"

namespace vobench {

class PointTracker {
 public:
  // `out` and `folder` as of Tracker. Throws BadInput.
  PointTracker(const TrackerSetup& setup, const vo::Camera& camera, const std::optional<std::filesystem::path>& out,
               const std::string& folder);

  vo::Estimate Track(const vo::PointFrame& frame);
  // What the last estimate is the moments of.
  const std::vector<vo::BeliefComponent>& mixture() const { return odometry_.Mixture(); }

  // The files of the run folder, but for the truth. Throws std::runtime_error.
  void Write() const { recorder_.Write(odometry_.Map()); }

  std::vector<vo::MapPoint> map() const { return odometry_.Map(); }
  const report::RunEntry& entry() const { return entry_; }
  evaluation::EstimateRun Estimates() const { return recorder_.Run(); }  // all of them, read from the spool

 private:
  report::RunEntry entry_;
  vo::PointOdometry odometry_;
  Recorder recorder_;
};

}  // namespace vobench
