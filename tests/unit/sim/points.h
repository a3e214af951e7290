// Scenarios of points for tests.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/points/point_world.h"

namespace sim {

// A camera of 640 x 480 at rest at the origin, looking along +z; one second at 30 Hz.
inline Scenario PointScenario(Landmarks landmarks = Landmarks::prior, std::uint64_t seed = 1) {
  Scenario scenario;
  scenario.name = "points";
  scenario.seed = seed;
  scenario.points.emplace();
  scenario.points->landmarks = landmarks;
  scenario.time = {30, 1};
  SampledMotion motion;
  motion.position_noise = motion.orientation_noise = 0;
  motion.knot_step_s = 1.0 / 30;
  scenario.motion = motion;
  return scenario;
}

// The same, drifting and turning to the right.
inline Scenario MovingPointScenario(Landmarks landmarks = Landmarks::prior, std::uint64_t seed = 1) {
  Scenario scenario = PointScenario(landmarks, seed);
  SampledMotion motion = std::get<SampledMotion>(scenario.motion);
  motion.velocity = {0.3, 0, 0.1};
  motion.angular_rate = {0, 0.4, 0};
  motion.position_noise = 0.5;
  motion.orientation_noise = 0.3;
  scenario.motion = motion;
  return scenario;
}

inline std::vector<PointFrame> Play(PointWorld& world) {
  std::vector<PointFrame> frames;
  while (auto frame = world.Next()) frames.push_back(*std::move(frame));
  return frames;
}

}  // namespace sim
