#include "sim/sensor/presets.h"

namespace sim {
namespace {

// TUM freiburg1: fitted to recorded frames by `vobench fit-camera`.
SensorParams Kinect() {
  SensorParams p;
  p.exposure_s = 0.020;
  p.readout_s = 0.026;
  p.mosaic = Mosaic::demosaiced;
  p.full_well_e = 6000;
  p.read_noise_e = 12;
  return p;
}

SensorParams IclNuim() {
  SensorParams p;
  p.exposure_s = 0;
  p.time_samples = 1;
  p.full_well_e = 4000;
  p.read_noise_e = 10;
  return p;
}

}  // namespace

std::vector<std::pair<std::string, SensorParams>> SensorPresets() {
  return {{"none", {}}, {"kinect", Kinect()}, {"icl_nuim", IclNuim()}};
}

}  // namespace sim
