// Parameters of optics and sensor, in the order of the signal path.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "tools/base/settings/fields.h"

namespace sim {

enum class Response { linear, srgb };  // srgb: IEC 61966-2-1
enum class Mosaic { none, raw, demosaiced };

using settings::Range;
using settings::Unit;

// Optics in front of the sensor, apart from the lens's distortion (sim/sensor/camera.h).
struct OpticsParams {
  double aperture_m = 0.0;
  double focus_m = 2.0;
  bool natural_vignetting = false;
  double vignetting_2 = 0.0, vignetting_4 = 0.0, vignetting_6 = 0.0;
  double psf_sigma_px = 0.0;
};

template <class V>
void Visit(V& v, OpticsParams& p) {
  v("aperture", p.aperture_m, {Unit::length, Range{0, 1}, "diameter of the entrance pupil; 0: all is in focus"});
  v("focus", p.focus_m, {Unit::length, Range::Positive(), "Z of the plane in focus"});
  v("natural_vignetting", p.natural_vignetting, {"cos^4 of the angle from the optical axis"});
  v("vignetting_2", p.vignetting_2, {"v2 of 1 + v2 r^2 + v4 r^4 + v6 r^6, r in half diagonals"});
  v("vignetting_4", p.vignetting_4, {"v4 of the same"});
  v("vignetting_6", p.vignetting_6, {"v6 of the same"});
  v("psf_sigma", p.psf_sigma_px, {Unit::pixel, Range{0, 5}, "of the lens's Gaussian point-spread function"});
}

// Image processing between the sensor's linear signal and the file: sim/sensor/processing.h has the equations. As it
// is by default, it does nothing.
struct ProcessingParams {
  glm::dvec3 white_balance{1.0};
  glm::dvec3 color_red{1, 0, 0}, color_green{0, 1, 0}, color_blue{0, 0, 1};
  double black_clip = 0.0, contrast = 1.0, toe = 1.0, shoulder = 1.0;
  double denoise_sigma_px = 0.0, denoise_range = 0.02;
  double sharpen_bright = 0.0, sharpen_dark = 0.0, sharpen_sigma_px = 1.0;

  bool HasColor() const {
    return white_balance != glm::dvec3(1.0) || color_red != glm::dvec3(1, 0, 0) || color_green != glm::dvec3(0, 1, 0) ||
           color_blue != glm::dvec3(0, 0, 1);
  }
  bool HasSharpening() const { return sharpen_bright > 0 || sharpen_dark > 0; }
  bool on() const {
    const bool tone = black_clip != 0 || contrast != 1 || toe != 1 || shoulder != 1;
    return HasColor() || tone || denoise_sigma_px > 0 || HasSharpening();
  }
};

template <class V>
void Visit(V& v, ProcessingParams& p) {
  const Range coefficient{-8, 8}, exponent{0.2, 5};
  v("white_balance", p.white_balance, {Range{0.1, 10}, "factors of red, green and blue, in linear light"});
  v("color_red", p.color_red, {coefficient, "row of the colour matrix that gives red, in linear light"});
  v("color_green", p.color_green, {coefficient, "row of the colour matrix that gives green"});
  v("color_blue", p.color_blue, {coefficient, "row of the colour matrix that gives blue"});
  v("black_clip", p.black_clip,
    {Range{.min = 0, .max = 1, .below_max = true}, "code after the response that is black"});
  v("contrast", p.contrast, {Range{0.1, 10}, "slope of the tone curve above it, up to white"});
  v("toe", p.toe, {exponent, "exponent of the tone curve at black; above 1: darker shadows, with less noise"});
  v("shoulder", p.shoulder, {exponent, "the same at white; above 1: lights are compressed"});
  v("denoise_sigma", p.denoise_sigma_px, {Unit::pixel, Range{0, 3}, "of the spatial weights of denoising; 0: none"});
  v("denoise_range", p.denoise_range,
    {Range{.min = 0, .max = 1, .above_min = true}, "differences well above it stay, as a fraction of the scale"});
  v("sharpen_bright", p.sharpen_bright, {Range{0, 5}, "amount of unsharp masking where it brightens; 0: none"});
  v("sharpen_dark", p.sharpen_dark, {Range{0, 5}, "the same where it darkens"});
  v("sharpen_sigma", p.sharpen_sigma_px, {Unit::pixel, Range{0.3, 5}, "of the Gaussian that it subtracts"});
}

// Exposure time and gain of each frame from the brightness of the one before: sim/sensor/exposure.h.
struct AutoExposureParams {
  bool on = false;
  double target = 0.45;
  double speed = 0.2;
  double shortest_s = 0.00005, longest_s = 0.020;
  double highest_gain = 8.0;
};

template <class V>
void Visit(V& v, AutoExposureParams& p) {
  v("on", p.on, {"exposure time and gain follow the brightness of the frame before"});
  v("target", p.target, {Range::Between(0, 1), "mean of the picture after the response, as a fraction of the scale"});
  v("speed", p.speed, {Range{.min = 0, .max = 1, .above_min = true}, "share of the log error corrected per frame"});
  v("shortest", p.shortest_s, {Unit::time, Range::Positive(), "least exposure time"});
  v("longest", p.longest_s, {Unit::time, "largest exposure time, reached before the gain grows"});
  v("highest_gain", p.highest_gain, {Range::AtLeast(1), "largest gain"});
}

// Interval without light: frames whose exposure has its middle in [from_s, until_s) are dark.
struct Covered {
  double from_s = 0.0, until_s = 0.0;
};

// Settings of the image formation: sim/sensor/sensor.h has the model.
struct SensorParams {
  double exposure_s = 0.010;
  int time_samples = 16;
  double readout_s = 0.0;
  AutoExposureParams auto_exposure;
  std::vector<Covered> covered;
  OpticsParams optics;

  double white = 1.0;
  double full_well_e = 10000.0;
  double quantum_efficiency = 0.5;
  bool shot_noise = true;
  double photo_response_sigma = 0.0;
  double dark_current_e_s = 0.0, dark_sigma_e_s = 0.0;
  double hot_pixels = 0.0, hot_current_e_s = 1e5;
  double read_noise_e = 8.0;
  double gain = 1.0;
  double black_level = 0.0;
  Response response = Response::srgb;
  std::filesystem::path response_file;  // of what follows
  std::vector<double> light_of_code;    // inverse response, in place of `response`: at equally spaced codes, 0 ... 1
  int bit_depth = 8;
  bool color = true;
  Mosaic mosaic = Mosaic::none;
  ProcessingParams processing;
  int jpeg_quality = 0;

  bool IsCovered(double t_s) const;  // at the middle of an exposure
  double RowDelay(int height) const { return height > 1 ? readout_s / (height - 1) : 0.0; }
};

template <class V>
void Visit(V& v, SensorParams& p) {
  const Range share{0, 1}, not_negative = Range::AtLeast(0);
  v("exposure", p.exposure_s, {Unit::time, Range{0, 10}, "longer: more motion blur, not brighter; at most 1 / rate"});
  v("time_samples", p.time_samples, {Range{1, 1024}, "instants of which an exposure is the mean"});
  v("rolling_shutter", p.readout_s, {Unit::time, Range{-10, 10}, "readout time of all rows; below 0: upwards"});
  v.Child("auto_exposure", p.auto_exposure);
  v.Child("optics", p.optics);
  v("white", p.white, {Range::Positive(), "linear radiance that fills the scale at gain 1"});
  v("full_well", p.full_well_e, {Unit::electrons, Range{1, 1e9}, "electrons at `white`; fewer: more shot noise"});
  v("quantum_efficiency", p.quantum_efficiency,
    {Range{.min = 0, .max = 1, .above_min = true}, "electrons per photon: for figures in photons, not the images"});
  v("shot_noise", p.shot_noise, {"Poisson noise of the electrons"});
  v("photo_response_sigma", p.photo_response_sigma, {share, "fixed pattern of the sensitivity (PRNU), as a fraction"});
  v("dark_current", p.dark_current_e_s, {Unit::electron_rate, not_negative, "mean dark current"});
  v("dark_sigma", p.dark_sigma_e_s, {Unit::electron_rate, not_negative, "fixed pattern of the dark current (DSNU)"});
  v("hot_pixels", p.hot_pixels, {share, "share of hot pixels"});
  v("hot_current", p.hot_current_e_s,
    {Unit::electron_rate, not_negative, "mean of the dark current of hot pixels, exponentially distributed"});
  v("read_noise", p.read_noise_e, {Unit::electrons, not_negative, "standard deviation; 0: none"});
  v("gain", p.gain, {Range{1, 1000}, "analogue: full_well / gain electrons fill the scale"});
  v("black_level", p.black_level, {Range{.min = 0, .max = 1, .below_max = true}, "offset, as a fraction of the scale"});
  v("response", p.response, {{"linear", Response::linear}, {"srgb", Response::srgb}}, "camera response: IEC 61966-2-1");
  v("bit_depth", p.bit_depth, {Range{8, 16}, "above 8: 16-bit PNG, the numbers in the highest bits"});
  v("color", p.color, {"false: one channel of luminance"});
  v("mosaic", p.mosaic, {{"none", Mosaic::none}, {"raw", Mosaic::raw}, {"demosaiced", Mosaic::demosaiced}},
    "Bayer filter (RGGB): none; one raw channel; interpolated to three");
  v.Child("processing", p.processing);
  v("jpeg_quality", p.jpeg_quality, {Range{0, 100}, "compressed to JPEG and back; 0: not"});
}

}  // namespace sim
