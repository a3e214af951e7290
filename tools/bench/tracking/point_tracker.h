// One odometry on a world of points with known identity, with the record of its run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/result/run_json.h"
#include "tools/bench/tracking/recorder.h"
#include "tools/bench/tracking/tracker.h"
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

  // All of it, to be written and drawn. Throws std::runtime_error.
  RunData Result() const { return recorder_.Result(entry_, odometry_.Map()); }

  std::vector<vo::MapPoint> map() const { return odometry_.Map(); }
  const RunEntry& entry() const { return entry_; }
  evaluation::EstimateRun Estimates() const { return recorder_.Run(); }  // all of them, read from the spool

 private:
  RunEntry entry_;
  vo::PointOdometry odometry_;
  Recorder recorder_;
};

}  // namespace vobench
