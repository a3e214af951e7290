// Time stamps of the frames.
#pragma once

#include <cstdint>

#include "sim/scenario/scenario.h"

namespace sim {

// round(duration * rate). Throws std::invalid_argument when that is no frame, or more than ten million.
std::int64_t CountFrames(const TimeParams& time);

// k / rate, rounded to a nanosecond. Throws std::out_of_range unless 0 <= index < CountFrames(time).
std::int64_t StampNs(std::int64_t index, const TimeParams& time);

// Truth is that of the rounded stamp, the one that is written.
inline double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace sim
