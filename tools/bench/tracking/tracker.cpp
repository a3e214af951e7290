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

CalibrationRecord RecordOf(const vo::CalibrationEstimate& e, double focal_px) {
  const auto measured = [](const auto& of) {
    return of ? std::optional(CalibrationRecord::Measured{of->value, of->sigma}) : std::nullopt;
  };
  return {measured(e.readout_s),    e.readout_used_s, focal_px,
          measured(e.focal_factor), e.pattern_px,     e.focal_is_wrong()};
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
    } catch (const std::invalid_argument& error) {  // anything else is a programming error
      throw BadInput(error.what());
    }
  }();
  entry_.seconds += 1e-3 * prepared.ms + clock.seconds();
  recorder_.Add(prepared.frame, estimate, odometry_.Features());
  recorder_.Reissue(odometry_.Reissued());
}

std::optional<CalibrationRecord> Tracker::calibration() const {
  const auto calibration = odometry_.Calibration();
  return calibration ? std::optional(RecordOf(*calibration, focal_px_)) : std::nullopt;
}

RunData Tracker::Result(const std::vector<vo::MapPoint>& map) const {
  RunData data = RecordedOdometry::Result(map);
  data.entry.calibration = calibration();
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
