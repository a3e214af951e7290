#include "sim/sensor/exposure.h"

#include <cstddef>
#include <stdexcept>

namespace sim {

std::vector<double> ExposureTimes(double middle_s, double exposure_s, int samples) {
  if (samples < 1 || !(exposure_s >= 0)) throw std::invalid_argument("an exposure needs samples >= 1 and a time >= 0");
  std::vector<double> times(static_cast<std::size_t>(samples));
  for (int i = 0; i < samples; ++i) {
    times[static_cast<std::size_t>(i)] = middle_s + exposure_s * ((i + 0.5) / samples - 0.5);
  }
  return times;
}

}  // namespace sim
