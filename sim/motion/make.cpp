#include "sim/motion/make.h"

#include <stdexcept>
#include <string>

#include "sim/motion/path.h"
#include "sim/motion/recorded.h"
#include "sim/motion/sampled.h"
#include "sim/motion/spline.h"

namespace sim {

std::unique_ptr<Trajectory> MakeTrajectory(const MotionDescription& motion, std::uint64_t seed, double last_stamp_s,
                                           double margin_s) {
  if (const auto* sampled = std::get_if<SampledMotion>(&motion)) {
    return std::make_unique<SampledTrajectory>(*sampled, seed, last_stamp_s + margin_s);
  }
  if (const auto* path = std::get_if<PathMotion>(&motion)) return std::make_unique<PathTrajectory>(*path);
  if (const auto* recorded = std::get_if<RecordedMotion>(&motion))
    return MakeRecordedTrajectory(*recorded, last_stamp_s);
  auto trajectory = std::make_unique<SplineTrajectory>(std::get<ScriptedMotion>(motion).keys);
  if (trajectory->end_s() < last_stamp_s) {
    throw std::invalid_argument("the last key pose is at " + std::to_string(trajectory->end_s()) +
                                " s, before the last frame at " + std::to_string(last_stamp_s) + " s");
  }
  return trajectory;
}

}  // namespace sim
