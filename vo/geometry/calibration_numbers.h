// Conversion of calibration coefficients, in the common order of OpenCV, ROS, EuRoC and Kalibr, to a camera.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "vo/geometry/camera.h"

namespace vo {

// k1 k2 p1 p2 [k3], or k1 k2 k3 k4 for a fisheye lens (camera.lens); further ones must be zero. Returns the problem,
// worded to follow the name of the coefficients; empty: none.
std::string SetLens(std::span<const double> coefficients, Camera& camera);

// Camera matrix K, 3 x 3, row by row. Returns its problems.
std::vector<std::string> SetMatrix(std::span<const double> matrix, Camera& camera);

}  // namespace vo
