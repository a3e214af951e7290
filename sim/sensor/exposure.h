// Exposure: time interval of each row (global or rolling shutter) and aperture.
#pragma once

#include <string>
#include <vector>

namespace sim {

// Row y of h collects light for `exposure_s` around middle_s + row_delay_s (y - (h - 1) / 2): the stamp `middle_s` is
// the middle of the exposure of the middle row, and of all rows of a global shutter (row_delay_s = 0). A negative delay
// reads from the last row to the first.
struct Exposure {
  double middle_s = 0.0;
  double exposure_s = 0.0;   // >= 0
  double row_delay_s = 0.0;  // from a row to the next
  int time_samples = 1;      // equal parts of the exposure that are looked at, each at its own moment
  double aperture_m = 0.0;   // diameter of a thin lens at the camera's centre, in its x-y plane; 0: a pinhole
  double focus_m = 1.0;      // Z of the plane that the lens makes sharp

  double RowMiddle(double row, int height) const { return middle_s + row_delay_s * (row - 0.5 * (height - 1)); }
};

// Everything wrong with it, one sentence each; empty when all is well.
std::vector<std::string> Problems(const Exposure& exposure);

}  // namespace sim
