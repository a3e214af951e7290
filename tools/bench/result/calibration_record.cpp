#include "tools/bench/result/calibration_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace vobench {
namespace {

using Json = nlohmann::ordered_json;
using Measured = CalibrationRecord::Measured;

constexpr double kConfidence95 = 1.96;

Json Of(const Measured& m, const char* unit, const char* how) {
  return {{"value", m.value},
          {"unit", unit},
          {"how", how},
          {"sigma", m.sigma},
          {"interval_95_percent", {m.value - kConfidence95 * m.sigma, m.value + kConfidence95 * m.sigma}}};
}

Measured MeasuredFrom(const Json& json) { return {json.at("value").get<double>(), json.at("sigma").get<double>()}; }

std::string FocalText(const CalibrationRecord& record) {
  return fmt::format("{:.1f} ± {:.1f} px", record.focal_factor->value * record.focal_px,
                     kConfidence95 * record.focal_factor->sigma * record.focal_px);
}

}  // namespace

Json ToJson(const CalibrationRecord& record) {
  Json json = {{"how", "bundle adjustment of windows of 30 frames, random-effects mean over them: docs/calibration.md"},
               {"rolling_shutter_used_s", record.readout_used_s},
               {"focal_px", record.focal_px}};
  if (record.readout_s) json["rolling_shutter"] = Of(*record.readout_s, "s", "from the first row to the last");
  if (!record.focal_factor) return json;
  json["focal_factor"] = Of(*record.focal_factor, "1", "focal length that the matches prefer / the stated one");
  json["pattern_px"] = record.pattern_px;
  json["focal_is_wrong"] = record.focal_is_wrong;
  return json;
}

CalibrationRecord CalibrationFromJson(const Json& json) {
  CalibrationRecord record;
  record.readout_used_s = json.at("rolling_shutter_used_s").get<double>();
  record.focal_px = json.at("focal_px").get<double>();
  if (json.contains("rolling_shutter")) record.readout_s = MeasuredFrom(json.at("rolling_shutter"));
  if (!json.contains("focal_factor")) return record;
  record.focal_factor = MeasuredFrom(json.at("focal_factor"));
  record.pattern_px = json.at("pattern_px").get<double>();
  record.focal_is_wrong = json.at("focal_is_wrong").get<bool>();
  return record;
}

std::string CalibrationSummary(const CalibrationRecord& record) {
  std::string text;
  if (record.readout_s)
    text += fmt::format("Rolling shutter, estimated: {:.1f} ± {:.1f} ms (95 %); used: {:.1f} ms\n",
                        1e3 * record.readout_s->value, 1e3 * kConfidence95 * record.readout_s->sigma,
                        1e3 * record.readout_used_s);
  if (record.focal_factor)
    text += fmt::format("Focal length that the matches prefer: {} (95 %); stated: {:.1f} px\n", FocalText(record),
                        record.focal_px);
  return text;
}

std::string CalibrationWarning(const CalibrationRecord& record) {
  if (!record.focal_is_wrong) return "";
  return fmt::format(
      "the calibration looks wrong: the matches prefer a focal length of {} to {:.1f} px; at the stated one they have "
      "systematic errors of {:.2f} px rms over the image. Check fx, fy, the distortion and the image size",
      FocalText(record), record.focal_px, record.pattern_px);
}

}  // namespace vobench
