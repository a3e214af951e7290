// Shared parts of the reference tools' reproductions: numbers as text, named values, shifted trajectories.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tools/base/text.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/text_file.h"
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

struct NamedValue {
  std::string name;
  double value = 0;
  std::string unit;
};

// "NAME_rmse", "NAME_mean", ... of statistics in `unit`.
inline void Append(const std::string& name, const Statistics& s, const std::string& unit,
                   std::vector<NamedValue>& values) {
  values.insert(values.end(), {{name + "_rmse", s.rmse, unit},
                               {name + "_mean", s.mean, unit},
                               {name + "_median", s.median, unit},
                               {name + "_std", s.std, unit},
                               {name + "_min", s.min, unit},
                               {name + "_max", s.max, unit},
                               {name + "_samples", static_cast<double>(s.count), "1"}});
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
