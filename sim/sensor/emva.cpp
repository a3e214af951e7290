#include "sim/sensor/emva.h"

#include <cmath>

namespace sim {

EmvaFigures Emva(const SensorParams& p) {
  EmvaFigures f;
  const double codes = std::pow(2.0, p.bit_depth) - 1;
  f.system_gain = codes * p.gain / p.full_well_e;
  const double dark_e = p.dark_current_e_s * p.exposure_s;
  const double dark_variance = p.read_noise_e * p.read_noise_e + (p.shot_noise ? dark_e : 0.0);
  f.dark_noise_e = std::sqrt(dark_variance);
  f.saturation_e = (1 - p.black_level) * p.full_well_e / p.gain - dark_e;
  f.saturation_p = f.saturation_e / p.quantum_efficiency;
  // SNR = N / sqrt(N + sigma_d^2 + sigma_q^2 / K^2) = 1.
  const double floor = dark_variance + 1 / (12 * f.system_gain * f.system_gain);
  const double shot = p.shot_noise ? 1.0 : 0.0;
  f.sensitivity_p = (0.5 * shot + std::sqrt(0.25 * shot + floor)) / p.quantum_efficiency;
  f.snr_max = f.saturation_e / std::sqrt(shot * f.saturation_e + floor);
  f.dynamic_range = f.saturation_p / f.sensitivity_p;
  f.prnu_percent = 100 * p.photo_response_sigma;
  f.dsnu_e = p.dark_sigma_e_s * p.exposure_s;
  return f;
}

}  // namespace sim
