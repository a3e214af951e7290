// Conversion from types of the simulator to those of the odometry (images) and of the evaluation (truth).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/points/point_world.h"
#include "sim/simulator.h"
#include "tools/bench/points/truth.h"
#include "vo/base/source.h"
#include "vo/geometry/camera.h"
#include "vo/point_odometry.h"

namespace vobench {

vo::Camera ToOdometry(const sim::CameraParams& camera);
// Without its rolling shutter, which belongs to the sensor.
sim::CameraParams ToSimulator(const vo::Camera& camera);
// The same as ToOdometry, with the rolling shutter of its sensor.
vo::Camera CameraOf(const sim::Scenario& scenario);
// A copy of the pixels, in OpenCV's order of colours.
vo::Frame ToOdometry(const sim::Frame& frame);
vo::PointFrame ToOdometry(const sim::PointFrame& frame);

// Truth of `frames` frames from `first` on.
Truth TruthOf(const sim::Simulator& simulator, std::int64_t first, std::int64_t frames = 1);

// To stderr, one line each.
void PrintWarnings(const std::vector<std::string>& warnings);

}  // namespace vobench
