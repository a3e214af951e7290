#include "tools/bench/tracking/tracker.h"

#include <stdexcept>

#include "tools/bench/errors.h"
#include "tools/bench/provenance.h"
#include "tools/bench/systems/systems.h"

namespace vobench {
namespace {

std::optional<std::filesystem::path> Within(const std::optional<std::filesystem::path>& out,
                                            const std::string& folder) {
  if (!out) return std::nullopt;
  return (*out / folder).lexically_normal();
}

CalibrationRecord RecordOf(const vo::CalibrationEstimate& estimate, double focal_px) {
  CalibrationRecord record;
  if (estimate.readout_s) record.readout_s = {estimate.readout_s->value, estimate.readout_s->sigma};
  record.readout_used_s = estimate.readout_used_s;
  record.focal_px = focal_px;
  if (estimate.focal_factor) record.focal_factor = {estimate.focal_factor->value, estimate.focal_factor->sigma};
  record.pattern_px = estimate.pattern_px;
  record.focal_is_wrong = estimate.focal_is_wrong();
  return record;
}

}  // namespace

template <class Odometry>
RecordedOdometry<Odometry>::RecordedOdometry(const TrackerSetup& setup, const vo::Camera& camera,
                                             const std::string& folder, Recorder recorder)
    : entry_{setup.system, setup.seed, folder, 0},
      odometry_(
          Input([&] { return Odometry(camera, ForSystem(setup.system, setup.params), setup.prior, setup.seed); })),
      recorder_(std::move(recorder)) {}

Tracker::Tracker(const TrackerSetup& setup, const vo::Camera& camera, std::int64_t frames,
                 const std::optional<std::filesystem::path>& out, const std::string& folder)
    : RecordedOdometry(setup, camera, folder, Recorder(frames, Within(out, folder))), focal_px_(camera.fx) {}

void Tracker::Track(const vo::PreparedFrame& prepared) {
  const Clock clock;
  const vo::Estimate estimate = [&] {
    try {
      return odometry_.Track(prepared);
    } catch (const std::invalid_argument& error) {  // anything else is our bug
      throw BadInput(error.what());
    }
  }();
  entry_.seconds += 1e-3 * prepared.ms + clock.seconds();
  recorder_.Add(prepared.frame, estimate, odometry_.Features());
  recorder_.Reissue(odometry_.Reissued());
}

RunData Tracker::Result(const std::vector<vo::MapPoint>& map) const {
  RunData data = RecordedOdometry::Result(map);
  if (const auto calibration = odometry_.Calibration()) data.entry.calibration = RecordOf(*calibration, focal_px_);
  return data;
}

PointTracker::PointTracker(const TrackerSetup& setup, const vo::Camera& camera,
                           const std::optional<std::filesystem::path>& out, const std::string& folder)
    : RecordedOdometry(setup, camera, folder, Recorder(Within(out, folder))) {}

vo::Estimate PointTracker::Track(const vo::PointFrame& frame) {
  const Clock clock;
  const vo::Estimate estimate = odometry_.Track(frame);
  entry_.seconds += clock.seconds();
  recorder_.Add(estimate);
  recorder_.Reissue(odometry_.Reissued());
  return estimate;
}

}  // namespace vobench
