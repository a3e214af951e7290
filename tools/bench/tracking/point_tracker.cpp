#include "tools/bench/tracking/point_tracker.h"

#include "tools/bench/errors.h"
#include "tools/bench/provenance.h"
#include "tools/bench/systems/systems.h"

namespace vobench {

PointTracker::PointTracker(const TrackerSetup& setup, const vo::Camera& camera,
                           const std::optional<std::filesystem::path>& out, const std::string& folder)
    : entry_{setup.system, setup.seed, folder, 0},
      odometry_(Input(
          [&] { return vo::PointOdometry(camera, ForSystem(setup.system, setup.params), setup.prior, setup.seed); })),
      recorder_(out ? std::optional(*out / folder) : std::nullopt) {}

vo::Estimate PointTracker::Track(const vo::PointFrame& frame) {
  const Clock clock;
  const vo::Estimate estimate = odometry_.Track(frame);
  entry_.seconds += clock.seconds();
  recorder_.Add(estimate);
  return estimate;
}

}  // namespace vobench
