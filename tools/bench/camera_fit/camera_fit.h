// Settings of a simulated sensor whose pictures have the statistics of recorded ones.
// Source: indirect inference (Gourieroux, Monfort and Renault 1993): flats and slanted edges go through the simulated
//   sensor until the same statistics come out as of the recording; EMVA 1288 (photon transfer), ISO 12233 (edges).
// Assumed: a scene at rest; shot and read noise; denoising and sharpening of the same strength at all levels. Units:
// codes 0 ... 255 of the green or grey channel, px. Pictures: CV_8UC1 or CV_8UC3 (BGR).
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "sim/sensor/description.h"

namespace vobench {

// Displacement to the next picture of the 49 x 49 px around a point, by normalised correlation, within 32 px.
struct Motion {
  cv::Point2f at, by;
};
struct Pair {
  cv::Mat picture, next;
  std::vector<Motion> motions;  // on a grid, where they are clear
  const Motion* Nearest(cv::Point2f at, double reach) const;
};
Pair MakePair(const cv::Mat& picture, const cv::Mat& next);

// Noise by range of 20 codes: the smaller of two estimates, from the flattest 16 x 16 blocks by the gradient of the
// blurred picture (a twentieth of them), and from the difference of both pictures over a quarter of the blocks that
// move by whole pixels (to 0.15).
struct NoiseLevel {
  double code = 0;
  double sigma = 0;  // median over blocks, after (1, -2, 1) x (1, -2, 1) / 6, which keeps that of white noise
  std::size_t blocks = 0;
};
struct NoiseStatistics {
  std::vector<NoiseLevel> levels;
  std::array<double, 2>
      correlation{};       // of neighbours in a row, in a column, beside a Gaussian of 2 px; of differences
  double lattice = 1;      // variance where x + y is even, over that where it is odd, in one picture
  std::size_t blocks = 0;  // behind the correlation
};
NoiseStatistics MeasureNoise(std::span<const Pair> pairs);

// A step between two flat sides in a row (or column) of the grey picture.
struct Edge {
  cv::Point2f at;
  bool in_column = false;
  double slope = 0;             // of the edge: across over along the row
  double width = 0;             // 10 ... 90 %, along the row
  double bright = 0, dark = 0;  // halo: mean 1.5, 2, 2.5, 3 px from the middle, beyond the side, over the step
};
std::vector<Edge> FindEdges(const cv::Mat& picture);
// Of the sharper half: halos in the median; of those within 0.06 of these, the width.
struct EdgeStatistics {
  std::size_t count = 0;
  double width = 0, bright = 0, dark = 0;
};
EdgeStatistics Summarise(std::vector<Edge> edges);

double Quantile(std::vector<double> values, double p);  // 0 of nothing
cv::Mat Grey(const cv::Mat& picture);                   // CV_8UC1

struct Recording {
  double period_s = 0;                     // median time between frames
  std::vector<Pair> pairs;                 // from all over the recording
  std::vector<std::vector<cv::Mat>> runs;  // of frames in a row, for what is seen at several places
};
struct Measure {
  double value = 0, sigma = 0;
};

// From edges in motion: width^2 = that at rest^2 + kBlur (|v| exposure)^2; kBlur: from 0.547, of a Gaussian blurred a
// little, to 0.64, of a box alone. `at_rest`: of the slowest eighth. None where the motion does not determine it.
constexpr double kBlur = 0.59;
std::optional<Measure> FitExposure(const Recording& recording, EdgeStatistics& at_rest);

// v2 of 1 + v2 r^2, r in half diagonals, from the brightness of what moves through the picture at a constant exposure;
// its standard deviation from that over the runs. None where too little moves.
std::optional<Measure> FitVignetting(const Recording& recording, const std::vector<double>& light_of_code);

struct CameraFit {
  NoiseStatistics noise;
  EdgeStatistics edges;
  double noise_misfit = 0;  // rms of the log of the noise's ratio to the model
  std::optional<Measure> exposure_s, vignetting_2;
  bool noise_known = false, edges_known = false;
  sim::SensorParams sensor;
};
CameraFit FitCamera(const Recording& recording);

}  // namespace vobench
