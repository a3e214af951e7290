#include "sim/sensor/exposure.h"

#include <algorithm>
#include <cmath>

#include "sim/sensor/sensor.h"

namespace sim {
namespace {

// Root of an increasing function, or the end that is nearest to it: the Illinois algorithm (Dowell and Jarratt, 1971).
template <class Function>
double Root(double low, double high, const Function& f) {
  constexpr double kClose = 1e-10;
  double below = f(low), above = f(high), x = below < 0 ? high : low;
  if (below >= 0 || above <= 0) return x;
  for (int last = 0; high - low > kClose;) {
    x = (low * above - high * below) / (above - below);
    const double value = f(x);
    if (std::abs(value) < kClose) break;
    const int side = value < 0 ? -1 : 1;
    (side < 0 ? low : high) = x;
    (side < 0 ? below : above) = value;
    if (side == last) (side < 0 ? above : below) /= 2;
    last = side;
  }
  return x;
}

}  // namespace

std::vector<std::string> Problems(const Exposure& exposure) {
  std::vector<std::string> problems;
  if (exposure.time_samples < 1) problems.push_back("an exposure needs at least one time sample");
  if (!(exposure.exposure_s >= 0) || !std::isfinite(exposure.exposure_s))
    problems.push_back("an exposure takes a time that is not negative");
  if (!std::isfinite(exposure.row_delay_s) || !std::isfinite(exposure.middle_s))
    problems.push_back("the times of an exposure are finite");
  if (!(exposure.aperture_m >= 0) || !std::isfinite(exposure.aperture_m))
    problems.push_back("an aperture is not negative");
  if (!(exposure.focus_m > 0)) problems.push_back("the plane of focus lies in front of the camera");
  return problems;
}

AutoExposure::AutoExposure(const SensorParams& sensor)
    : sensor_(sensor), tone_(sensor), setting_{sensor.exposure_s, sensor.gain} {
  ThrowIfAny(Problems(sensor), "auto exposure");
}

double AutoExposure::Brightness(const RadianceImage& frame, double signal) const {
  const double dark = sensor_.black_level + signal * sensor_.dark_current_e_s / sensor_.full_well_e;
  const double scale = signal / (sensor_.white * sensor_.exposure_s);
  const bool processed = sensor_.processing.on();
  const auto encoded = [&](double x) {
    return processed ? double{tone_(static_cast<float>(x))} : EncodeResponse(sensor_, x);
  };
  const auto shown = [&](float light) { return encoded(std::min(1.0, dark + scale * light)); };
  double sum = 0;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3) {
    const float* rgb = &frame.rgb[i];
    if (!sensor_.color) {
      sum += shown(Luminance(rgb));
    } else if (sensor_.mosaic == Mosaic::raw) {
      sum += (shown(rgb[0]) + 2 * shown(rgb[1]) + shown(rgb[2])) / 4;
    } else {
      sum += (shown(rgb[0]) + shown(rgb[1]) + shown(rgb[2])) / 3;
    }
  }
  return 3 * sum / static_cast<double>(frame.rgb.size());
}

void AutoExposure::Meter(const RadianceImage& frame) {
  const AutoExposureParams& p = sensor_.auto_exposure;
  const double lowest = p.shortest_s, highest = p.longest_s * p.highest_gain;
  const double wanted = Root(std::log(lowest), std::log(highest),
                             [&](double log_signal) { return Brightness(frame, std::exp(log_signal)) - p.target; });
  const double now = std::log(setting_.exposure_s * setting_.gain);
  const double next = std::clamp(std::exp(now + p.speed * (wanted - now)), lowest, highest);
  setting_.exposure_s = std::clamp(next, p.shortest_s, p.longest_s);
  setting_.gain = std::max(1.0, next / setting_.exposure_s);
}

}  // namespace sim
