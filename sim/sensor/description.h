// Purpose: the settings of the sensor.
#pragma once

namespace sim {

enum class Response { linear, srgb };  // srgb: IEC 61966-2-1

// How light becomes bytes: sim/sensor/sensor.h has the model.
struct SensorParams {
  double exposure_s = 0.010;     // longer: more motion blur. Brightness does not depend on it (`white` fixes that)
  int time_samples = 16;         // instants averaged over the exposure; fewer: long blur falls apart into copies
  double white = 1.0;            // linear radiance that fills the scale; smaller: brighter pictures
  double full_well_e = 10000.0;  // electrons at `white`; fewer: more shot noise
  bool shot_noise = true;
  double read_noise_e = 8.0;  // standard deviation, in electrons; 0: none
  Response response = Response::srgb;
  bool color = true;  // false: one channel of luminance
};

}  // namespace sim
