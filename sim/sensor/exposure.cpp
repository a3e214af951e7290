#include "sim/sensor/exposure.h"

#include <cmath>

namespace sim {

std::vector<std::string> Problems(const Exposure& exposure) {
  std::vector<std::string> problems;
  if (exposure.time_samples < 1) problems.push_back("an exposure needs at least one time sample");
  if (!(exposure.exposure_s >= 0) || !std::isfinite(exposure.exposure_s))
    problems.push_back("an exposure takes a time that is not negative");
  if (!std::isfinite(exposure.row_delay_s) || !std::isfinite(exposure.middle_s))
    problems.push_back("the times of an exposure are finite");
  if (!(exposure.aperture_m >= 0) || !std::isfinite(exposure.aperture_m))
    problems.push_back("an aperture is not negative");
  if (!(exposure.focus_m > 0)) problems.push_back("the plane of focus lies in front of the camera");
  return problems;
}

}  // namespace sim
