#include "vo/geometry/calibration_numbers.h"

namespace vo {

std::string SetLens(std::span<const double> coefficients, Camera& camera) {
  const std::size_t most = camera.lens == Lens::fisheye ? 4 : 5;
  if (coefficients.size() < 4)
    return "must be k1, k2, p1, p2 and perhaps k3, or k1 ... k4 of an equidistant lens; there are " +
           std::to_string(coefficients.size()) + " numbers";
  for (std::size_t i = most; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0)
      return "has more than " + std::to_string(most) + " coefficients that are not zero: that lens is not known here";
  }
  camera.k1 = coefficients[0];
  camera.k2 = coefficients[1];
  const bool fisheye = camera.lens == Lens::fisheye;
  (fisheye ? camera.k3 : camera.p1) = coefficients[2];
  (fisheye ? camera.k4 : camera.p2) = coefficients[3];
  if (!fisheye && coefficients.size() > 4) camera.k3 = coefficients[4];
  return "";
}

std::vector<std::string> SetMatrix(std::span<const double> matrix, Camera& camera) {
  if (matrix.size() != 9) return {"'camera_matrix' must have 3 x 3 numbers"};
  std::vector<std::string> problems;
  camera.fx = matrix[0];
  camera.cx = matrix[2];
  camera.fy = matrix[4];
  camera.cy = matrix[5];
  if (!(camera.fx > 0 && camera.fy > 0)) problems.emplace_back("'camera_matrix': fx and fy must be positive");
  if (matrix[1] != 0) problems.emplace_back("'camera_matrix': skew is not known here");
  return problems;
}

}  // namespace vo
