// Exposure: time interval of each row (global or rolling shutter) and aperture; automatic exposure control.
#pragma once

#include <string>
#include <vector>

#include "sim/sensor/description.h"
#include "sim/sensor/image.h"
#include "sim/sensor/processing.h"

namespace sim {

// Row y of h collects light for `exposure_s` around middle_s + row_delay_s (y - (h - 1) / 2): the stamp `middle_s` is
// the middle of the exposure of the middle row, and of all rows of a global shutter (row_delay_s = 0). A negative delay
// reads from the last row to the first.
struct Exposure {
  double middle_s = 0.0;
  double exposure_s = 0.0;   // >= 0
  double row_delay_s = 0.0;  // from a row to the next
  int time_samples = 1;      // equal parts of the exposure, each sampled at its own moment
  double aperture_m = 0.0;   // diameter of a thin lens at the camera's centre, in its x-y plane; 0: a pinhole
  double focus_m = 1.0;      // Z of the plane that the lens makes sharp

  double RowMiddle(double row, int height) const { return middle_s + row_delay_s * (row - 0.5 * (height - 1)); }
};

// Problems of the exposure, one sentence each; empty if it is valid.
std::vector<std::string> Problems(const Exposure& exposure);

// Exposure time and gain of one frame.
struct ExposureSetting {
  double exposure_s = 0.0;
  double gain = 1.0;
};

// Exposure time and gain from the mean brightness of the previous frame. The signal of frame k is proportional to
// s = exposure_s * gain. With m(s) the mean of the picture that it makes, over its pixels and channels, with dark
// current and black level, after the response and tone curve, the next frame gets
//   log s' = log s + speed (log s* - log s),   m(s*) = target,
// within the limits; the exposure time grows before the gain does. The first frame has the sensor's own settings.
class AutoExposure {
 public:
  // Throws std::invalid_argument listing all Problems of the sensor.
  explicit AutoExposure(const SensorParams& sensor);

  const ExposureSetting& setting() const { return setting_; }
  // Radiances of the frame on the sensor before noise; a reduced resolution suffices.
  void Meter(const RadianceImage& frame);

 private:
  double Brightness(const RadianceImage& frame, double signal) const;

  SensorParams sensor_;
  ToneCurve tone_;
  ExposureSetting setting_;
};

}  // namespace sim
