#include "sim/scenario/sensor_reader.h"

#include <cmath>

#include "sim/sensor/sensor.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

enum class Preset { none, kinect, icl_nuim };

// What the other keys begin with: docs/sensor.md says where the numbers come from.
void Apply(Preset preset, SensorParams& sensor) {
  if (preset == Preset::kinect) {
    sensor.exposure_s = 0.020;
    sensor.readout_s = 0.026;
    sensor.mosaic = Mosaic::demosaiced;
    sensor.full_well_e = 6000;
    sensor.read_noise_e = 12;
  }
  if (preset == Preset::icl_nuim) {
    sensor.exposure_s = 0;
    sensor.time_samples = 1;
    sensor.full_well_e = 4000;
    sensor.read_noise_e = 10;
  }
}

}  // namespace

void ReadCamera(Section section, CameraParams& camera) {
  const bool good = ReadFields(section, camera);
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy"}) section.RequirePresent(key);
  if (good) section.Reject(Problems(camera));
}

void ReadSensor(Section section, double rate_hz, SensorParams& sensor) {
  section.Allow("preset");
  if (section.Has("preset")) {  // a manifest without one says nothing of it
    Preset preset = Preset::none;
    section.ReadChoice("preset", preset,
                       {{"none", Preset::none}, {"kinect", Preset::kinect}, {"icl_nuim", Preset::icl_nuim}});
    Apply(preset, sensor);
  }
  section.Allow("covered");
  if (section.Has("covered")) {  // a manifest of a sequence without says nothing of it
    for (Section& item : section.List("covered")) {
      Covered& covered = sensor.covered.emplace_back();
      item.Require("from", covered.from_s, Unit::time);
      item.Require("until", covered.until_s, Unit::time);
    }
  }
  ReadFields(section, sensor);
  section.Reject(Problems(sensor));
  settings::FieldCheck check;
  const auto within_frame = [&](const char* key, double value_s) {
    check.Require(std::abs(value_s) * rate_hz <= 1, key, value_s, "s is longer than the time between two frames");
  };
  within_frame("exposure", sensor.exposure_s);
  within_frame("rolling_shutter", sensor.readout_s);
  if (sensor.auto_exposure.on) within_frame("auto_exposure.longest", sensor.auto_exposure.longest_s);
  section.Reject(check.problems);
}

}  // namespace sim
