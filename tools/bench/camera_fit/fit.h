// Settings of a simulated sensor whose pictures have the statistics of recorded ones.
// Source: indirect inference (Gourieroux, Monfort and Renault 1993): a chart of flats and slanted edges goes through the
//   simulated sensor, and its settings are adjusted until the same statistics come out of it as of the recording.
// What is assumed: shot and read noise, the same strength of denoising at all levels; a scene that stands still.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/sensor/description.h"
#include "tools/bench/camera_fit/statistics.h"

namespace vobench {

struct Recording {
  std::int64_t frames = 0;
  double period_s = 0;                     // median time between frames
  std::vector<Pair> pairs;                 // from all over the recording
  std::vector<std::vector<cv::Mat>> runs;  // of frames in a row, for what is seen at several places
};

// Of the sharper half: halos and levels in the median; of those within 0.06 of these halos, the width.
struct EdgeStatistics {
  std::size_t count = 0;
  double width = 0, bright = 0, dark = 0, low = 0, high = 0;
};
EdgeStatistics Summarise(std::vector<Edge> edges);

struct Measure {
  double value = 0, sigma = 0;
};

struct CameraFit {
  NoiseStatistics noise;
  EdgeStatistics edges;
  double noise_misfit = 0;      // rms of the log of the noise's ratio to the model
  double black = 0, white = 0;  // share of clipped pixels
  std::optional<Measure> exposure_s;
  std::optional<Measure> corner;  // vignetting at the farthest corner
  bool noise_known = false, edges_known = false;
  sim::SensorParams sensor;
};

CameraFit FitCamera(const Recording& recording);

// Exposure time from the width of edges against their motion in the picture: with L = |v| exposure the width is that of
// a Gaussian convolved with a box of L. `at_rest`: of the slowest eighth. None where the motion does not tell it.
std::optional<Measure> FitExposure(const Recording& recording, EdgeStatistics& at_rest);

// 1 + v2 r^2 + v4 r^4 of r in half diagonals, from the brightness of what moves through the picture. `linear`: of codes.
// None where too little does. Values v2, v4 go to `optics`; returned is the factor at r = 1.
std::optional<Measure> FitVignetting(const Recording& recording, const std::vector<double>& linear,
                                     sim::OpticsParams& optics);

}  // namespace vobench
