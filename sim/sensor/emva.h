// Figures of merit of the sensor by EMVA 1288.
// Source: EMVA Standard 1288, release 4.0 linear, sections 2 and 3: its equations in brackets.
#pragma once

#include "sim/sensor/description.h"

namespace sim {

struct EmvaFigures {
  double system_gain = 0.0;    // K: digital numbers per electron, before the response curve (6)
  double dark_noise_e = 0.0;   // sigma_d of the exposure: read noise and the shot noise of the dark current
  double saturation_p = 0.0;   // photons per pixel that fill the scale, above the black level
  double saturation_e = 0.0;   // the same in electrons
  double sensitivity_p = 0.0;  // absolute sensitivity threshold: photons at which SNR = 1 (27)
  double snr_max = 0.0;        // at saturation: sqrt(saturation_e) without a fixed pattern
  double dynamic_range = 0.0;  // saturation_p / sensitivity_p (28)
  double prnu_percent = 0.0;
  double dsnu_e = 0.0;  // of the exposure
};

// Of a picture with the given exposure time and gain; hot pixels apart.
EmvaFigures Emva(const SensorParams& params);

}  // namespace sim
