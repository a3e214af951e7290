// Calibration file of a camera as other systems read it.
// Source: the sample files and readers of ORB-SLAM2 and 3 (Settings), DSO (README, "Geometric Calibration File"), SVO
// (svo_ros/param/camera_pinhole.yaml), LSD-SLAM (Undistorter.cpp). What each counts from differs: with the
// centre of the first pixel at (0, 0), as here, DSO and LSD-SLAM (without distortion) want (c + 0.5) / size.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/campaign/external_system.h"

namespace vobench::campaign {

// As in docs/conventions.md: the centre of the first pixel is (0, 0).
struct Calibration {
  int width = 0, height = 0;              // [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;  // [px]
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  double k4 = 0;  // of a fisheye lens, which has no p1, p2
  bool fisheye = false;
  double rate_hz = 30;
};

// The text of the file. Throws std::invalid_argument where the format has no place for this lens.
std::string WriteCalibration(const Calibration& camera, CalibrationFormat format);

}  // namespace vobench::campaign
