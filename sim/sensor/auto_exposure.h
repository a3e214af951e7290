// Automatic exposure control: exposure time and gain from the mean brightness of the previous frame.
#pragma once

#include "sim/sensor/description.h"
#include "sim/sensor/radiance_image.h"

namespace sim {

// What the sensor is set to for one frame.
struct ExposureSetting {
  double exposure_s = 0.0;
  double gain = 1.0;
};

// The signal of frame k is proportional to s = exposure_s * gain. With m(s) the mean of the picture that it makes, over
// its pixels and channels, with dark current and black level, after the response, the next frame gets
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
  ExposureSetting setting_;
};

}  // namespace sim
