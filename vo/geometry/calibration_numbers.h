// Purpose: the numbers of a calibration file, in the order that OpenCV, ROS, EuRoC and Kalibr share, into a camera.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "vo/geometry/camera.h"

namespace vo {

// k1 k2 p1 p2 [k3] or, of a fisheye lens (camera.lens), k1 k2 k3 k4; what follows must be zero. Returns what is wrong with
// them, to be told after their name; empty: nothing.
std::string SetLens(std::span<const double> coefficients, Camera& camera);

// A camera matrix, 3 x 3, row by row. Returns what is wrong with it.
std::vector<std::string> SetMatrix(std::span<const double> matrix, Camera& camera);

}  // namespace vo
