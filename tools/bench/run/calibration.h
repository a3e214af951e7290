// Calibration file of a camera in the format of an external system.
// Source: the sample files and readers of ORB-SLAM2 and 3 (Settings), DSO (README, "Geometric Calibration File"), SVO
// (svo_ros/param/camera_pinhole.yaml), LSD-SLAM (Undistorter.cpp). Their pixel origins differ: with the centre of the
// first pixel at (0, 0), as here, DSO and LSD-SLAM (without distortion) take (c + 0.5) / size.
#pragma once

#include <string>

#include "sim/sensor/camera.h"
#include "tools/bench/campaign/external_system.h"

namespace vobench {

inline constexpr int kSideMultiple = 16;  // of the sides of images that are halved four times

// Whether the lens differs from a pinhole.
bool IsDistorted(const sim::CameraParams& camera);

// The text of the file; empty for formats without a calibration file. Throws std::invalid_argument where the format
// does not support this lens.
std::string WriteCalibration(const sim::CameraParams& camera, double rate_hz, campaign::CalibrationFormat format);

}  // namespace vobench
