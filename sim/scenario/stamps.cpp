#include "sim/scenario/stamps.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace sim {

std::int64_t CountFrames(const TimeParams& time) {
  const double frames = std::round(time.rate_hz * time.duration_s);
  if (!(time.rate_hz > 0) || !(frames >= 1 && frames <= 1e7)) {
    throw std::invalid_argument("simulator: the scenario has no frame, or more than ten million");
  }
  return static_cast<std::int64_t>(frames);
}

std::int64_t StampNs(std::int64_t index, const TimeParams& time) {
  if (index < 0 || index >= CountFrames(time)) {
    throw std::out_of_range("simulator: there is no frame " + std::to_string(index) + " of " +
                            std::to_string(CountFrames(time)));
  }
  return std::llround(static_cast<double>(index) * 1e9 / time.rate_hz);
}

}  // namespace sim
