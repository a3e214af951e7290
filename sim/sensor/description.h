// Parameters of optics and sensor, in the order of the signal path.
#pragma once

#include <vector>

namespace sim {

enum class Response { linear, srgb };  // srgb: IEC 61966-2-1
enum class Mosaic { none, raw, demosaiced };

// In front of the sensor, apart from the lens's distortion (sim/sensor/camera.h).
struct OpticsParams {
  double aperture_m = 0.0;  // diameter of the entrance pupil: what is not at focus_m is blurred. 0: all is sharp
  double focus_m = 2.0;     // Z of the plane that is sharp
  bool natural_vignetting = false;  // illuminance falls with cos^4 of the angle from the optical axis
  double vignetting_2 = 0.0;        // and with 1 + v2 r^2 + v4 r^4 + v6 r^6, where r is the distance from the principal
  double vignetting_4 = 0.0;        // point in half diagonals of the image
  double vignetting_6 = 0.0;
};

// Exposure time and gain of each frame from the brightness of the one before: sim/sensor/auto_exposure.h.
struct AutoExposureParams {
  bool on = false;
  double target = 0.45;         // mean of the picture that is sought, as a fraction of the scale, after the response
  double speed = 0.2;           // share of the error (of its logarithm) that is mended from frame to frame
  double shortest_s = 0.00005;  // exposure time,
  double longest_s = 0.020;     // which is used up before
  double highest_gain = 8.0;    // the gain is
};

// A hand before the lens: frames whose exposure has its middle in [from_s, until_s) see no light.
struct Covered {
  double from_s = 0.0, until_s = 0.0;
};

// How light becomes numbers: sim/sensor/sensor.h has the model.
struct SensorParams {
  double exposure_s = 0.010;  // longer: more motion blur. Brightness does not depend on it (`white` fixes that)
  int time_samples = 16;      // instants averaged over the exposure; fewer: long blur gets grainy
  double readout_s = 0.0;  // from the first row's exposure to the last's: rolling shutter. 0: all at once; < 0: upwards
  AutoExposureParams auto_exposure;
  std::vector<Covered> covered;
  OpticsParams optics;

  double white = 1.0;               // linear radiance that fills the scale at gain 1; smaller: brighter pictures
  double full_well_e = 10000.0;     // electrons at `white`; fewer: more shot noise
  double quantum_efficiency = 0.5;  // electrons per photon: no picture depends on it, figures in photons do
  bool shot_noise = true;
  double photo_response_sigma = 0.0;  // fixed pattern: each pixel collects 1 + this * z of its light (PRNU)
  double dark_current_e_s = 0.0;      // electrons per second of exposure that no light made; they have shot noise too
  double dark_sigma_e_s = 0.0;        // fixed pattern: of the dark current, from pixel to pixel (DSNU)
  double hot_pixels = 0.0;            // the share of pixels whose dark current is
  double hot_current_e_s = 1e5;       // exponentially distributed with this mean
  double read_noise_e = 8.0;          // standard deviation, in electrons; 0: none
  double gain = 1.0;                  // analogue, >= 1: full_well / gain electrons fill the scale
  double black_level = 0.0;           // added to the signal, as a fraction of the scale
  Response response = Response::srgb;
  int bit_depth = 8;             // 8 ... 16
  bool color = true;             // false: one channel of luminance
  Mosaic mosaic = Mosaic::none;  // raw: one channel behind a Bayer filter, RGGB; demosaiced: and colour again of it
  int jpeg_quality = 0;          // 1 ... 100: the picture has been a JPEG file; 0: not

  bool IsCovered(double t_s) const;  // at the middle of an exposure
  double RowDelay(int height) const { return height > 1 ? readout_s / (height - 1) : 0.0; }
};

}  // namespace sim
