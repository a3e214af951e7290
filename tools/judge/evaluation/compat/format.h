// Statistics of the reference tools' errors as text, and shifted trajectories.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/text.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation::compat {

constexpr double kDegrees = 180 / std::numbers::pi;

using base::Fixed;

// So many significant digits, with ".0" where a whole number would look like an integer, as Python has it.
inline std::string Significant(double value, int digits) {
  std::string text = base::Significant(value, digits);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

// Statistics by their names in the tools' output.
inline std::array<std::pair<std::string, double>, 6> Parts(const Statistics& s) {
  return {{{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std}, {"min", s.min}, {"max", s.max}}};
}

// Stamps later by offset, positions times scale.
inline Trajectory Shifted(Trajectory trajectory, std::int64_t offset_ns, double scale = 1) {
  for (StampedPose& pose : trajectory) {
    pose.stamp_ns += offset_ns;
    pose.p_WC *= scale;
  }
  return trajectory;
}

}  // namespace evaluation::compat
