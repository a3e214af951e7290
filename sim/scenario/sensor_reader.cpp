#include "sim/scenario/sensor_reader.h"

#include <cmath>
#include <string>

#include "sim/sensor/sensor.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

const Range kNotNegative = Range::AtLeast(0);

void ReadOptics(Section section, OpticsParams& optics) {
  section.Read("aperture", optics.aperture_m, Unit::length);
  section.Read("focus", optics.focus_m, Unit::length);
  section.Read("natural_vignetting", optics.natural_vignetting);
  section.Read("vignetting_2", optics.vignetting_2);
  section.Read("vignetting_4", optics.vignetting_4);
  section.Read("vignetting_6", optics.vignetting_6);
}

void ReadAutoExposure(Section section, AutoExposureParams& automatic) {
  section.Read("on", automatic.on);
  section.Read("target", automatic.target);
  section.Read("speed", automatic.speed);
  section.Read("shortest", automatic.shortest_s, Unit::time);
  section.Read("longest", automatic.longest_s, Unit::time);
  section.Read("highest_gain", automatic.highest_gain);
}

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
  section.Require("width", camera.width);
  section.Require("height", camera.height);
  section.Require("fx", camera.fx, Unit::pixel);
  section.Require("fy", camera.fy, Unit::pixel);
  section.Require("cx", camera.cx, Unit::pixel);
  section.Require("cy", camera.cy, Unit::pixel);
  Section lens = section.Child("distortion");
  lens.ReadChoice("model", camera.lens, {{"radial_tangential", Lens::radial_tangential}, {"fisheye", Lens::fisheye}});
  lens.Read("k1", camera.k1);
  lens.Read("k2", camera.k2);
  if (camera.lens == Lens::fisheye) {
    lens.Read("k3", camera.k3);
    lens.Read("k4", camera.k4);
  } else {
    lens.Read("p1", camera.p1);
    lens.Read("p2", camera.p2);
    lens.Read("k3", camera.k3);
  }
  for (const std::string& problem : Problems(camera)) {
    section.Reject(problem.substr(0, problem.find_first_of(" :")), "camera: " + problem);
  }
}

void ReadSensor(Section section, double rate_hz, SensorParams& sensor) {
  section.Allow("preset");
  if (section.Has("preset")) {  // a manifest without one says nothing of it
    Preset preset = Preset::none;
    section.ReadChoice("preset", preset,
                       {{"none", Preset::none}, {"kinect", Preset::kinect}, {"icl_nuim", Preset::icl_nuim}});
    Apply(preset, sensor);
  }
  section.Read("exposure", sensor.exposure_s, Unit::time, kNotNegative);
  section.Read("time_samples", sensor.time_samples);
  section.Read("rolling_shutter", sensor.readout_s, Unit::time);
  ReadAutoExposure(section.Child("auto_exposure"), sensor.auto_exposure);
  section.Allow("covered");
  if (section.Has("covered")) {  // a manifest of a sequence without says nothing of it
    for (Section& item : section.List("covered")) {
      Covered& covered = sensor.covered.emplace_back();
      item.Require("from", covered.from_s, Unit::time);
      item.Require("until", covered.until_s, Unit::time);
    }
  }
  ReadOptics(section.Child("optics"), sensor.optics);
  section.Read("white", sensor.white);
  section.Read("full_well", sensor.full_well_e, Unit::electrons);
  section.Read("quantum_efficiency", sensor.quantum_efficiency);
  section.Read("shot_noise", sensor.shot_noise);
  section.Read("photo_response_sigma", sensor.photo_response_sigma);
  section.Read("dark_current", sensor.dark_current_e_s, Unit::electron_rate);
  section.Read("dark_sigma", sensor.dark_sigma_e_s, Unit::electron_rate);
  section.Read("hot_pixels", sensor.hot_pixels);
  section.Read("hot_current", sensor.hot_current_e_s, Unit::electron_rate);
  section.Read("read_noise", sensor.read_noise_e, Unit::electrons, kNotNegative);
  section.Read("gain", sensor.gain);
  section.Read("black_level", sensor.black_level);
  section.ReadChoice("response", sensor.response, {{"linear", Response::linear}, {"srgb", Response::srgb}});
  section.Read("bit_depth", sensor.bit_depth);
  section.Read("color", sensor.color);
  section.ReadChoice("mosaic", sensor.mosaic,
                     {{"none", Mosaic::none}, {"raw", Mosaic::raw}, {"demosaiced", Mosaic::demosaiced}});
  section.Read("jpeg_quality", sensor.jpeg_quality);
  for (const std::string& problem : Problems(sensor)) {
    section.Reject(problem.substr(0, problem.find_first_of(" .:")), "sensor: " + problem);
  }
  const auto within_frame = [&](const char* key, const char* name, double value_s) {
    if (std::abs(value_s) * rate_hz <= 1) return;
    section.Reject(key, std::string("sensor: ") + name + " = " + settings::FormatNumber(value_s) +
                            " s is longer than the time between two frames");
  };
  within_frame("exposure", "exposure", sensor.exposure_s);
  within_frame("rolling_shutter", "rolling_shutter", sensor.readout_s);
  if (sensor.auto_exposure.on) within_frame("auto_exposure", "auto_exposure.longest", sensor.auto_exposure.longest_s);
}

}  // namespace sim
