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

// Errors of one kind, by the tool's own name; those of sub-trajectories begin with their length, "8.00m_pos".
struct NamedStatistics {
  std::string name;
  Statistics statistics;
  std::string unit;
};

// "trans_rmse = 0.0123456789012 m", a line each.
inline std::string Print(const std::vector<NamedStatistics>& errors) {
  std::string text;
  for (const auto& [name, statistics, unit] : errors) {
    for (const auto& [part, value] : Parts(statistics)) {
      text += name + "_" + part + " = " + base::Significant(value, 12) + " " + unit + "\n";
    }
    text += name + "_samples = " + std::to_string(statistics.count) + " 1\n";
  }
  return text;
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
