// What an odometry has found out about its camera: in run.json and metrics.json, and in words.
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

// One line for each quantity that was estimated, with its 95 % interval; ends with a line break. Empty where nothing was.
std::string CalibrationSummary(const CalibrationRecord& record);
// What is wrong, and what to check. Empty: nothing.
std::string CalibrationWarning(const CalibrationRecord& record);

}  // namespace vobench
