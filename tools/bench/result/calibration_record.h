// Estimated camera calibration of an odometry: in run.json and metrics.json, and as text.
// Source: docs/calibration.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace vobench {

struct CalibrationRecord {
  struct Measured {
    double value = 0, sigma = 0;
  };
  std::optional<Measured> readout_s;  // where it is not stated and the images show it
  double readout_used_s = 0;
  double focal_px = 0;                   // fx as stated
  std::optional<Measured> focal_factor;  // on it, where the images show it
  double pattern_px = 0;                 // rms residual of the stated focal length
  bool focal_is_wrong = false;
};

nlohmann::ordered_json ToJson(const CalibrationRecord& record);
// Throws nlohmann::json::exception.
CalibrationRecord CalibrationFromJson(const nlohmann::ordered_json& json);

// One line for each estimated quantity, with its 95 % interval; ends with a line break. Empty without any.
std::string CalibrationSummary(const CalibrationRecord& record);
// Problem of the calibration, and what to check. Empty: none.
std::string CalibrationWarning(const CalibrationRecord& record);

}  // namespace vobench
