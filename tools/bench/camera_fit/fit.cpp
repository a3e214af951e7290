#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/sensor/sensor.h"
#include "tools/bench/camera_fit/camera_fit.h"

namespace vobench {
namespace {

constexpr int kWidth = 320, kHeight = 256;  // of the chart

// Light of each code.
std::vector<double> LinearOf(const sim::SensorParams& sensor) {
  constexpr int kSteps = 1 << 14;
  const sim::ToneCurve curve(sensor);
  std::vector<double> linear;
  for (int i = 0, code = 0; code < 256; ++code) {
    while (i < kSteps && double{curve(static_cast<float>(i) / kSteps)} < code / 255.0) ++i;
    linear.push_back(static_cast<double>(i) / kSteps);
  }
  return linear;
}

cv::Mat Capture(const sim::SensorParams& sensor, sim::RadianceImage radiance, std::int64_t frame) {
  radiance.rgb = sim::GaussianBlur(radiance.rgb, kWidth, kHeight, 3, sensor.optics.psf_sigma_px);
  sim::Image image = sim::Sensor(sensor, 1).Capture(radiance, frame);
  return cv::Mat(kHeight, kWidth, CV_8UC(image.channels), image.data.data()).clone();  // grey: red and blue are alike
}

// Noise of a flat at the code, through the sensor.
NoiseStatistics FlatAt(const sim::SensorParams& sensor, double code) {
  const auto light = static_cast<float>(LinearOf(sensor)[static_cast<std::size_t>(std::lround(code))]);
  const sim::RadianceImage flat{kWidth, kHeight, std::vector<float>(std::size_t{3} * kWidth * kHeight, light)};
  const std::int64_t frame = 2 * std::lround(code);
  Pair pair{Capture(sensor, flat, frame), Capture(sensor, flat, frame + 1), {}};
  for (int i = 0; i < 56; ++i) pair.motions.push_back({cv::Point2f(cv::Point(i % 8, i / 8) * 40), {}});
  return MeasureNoise({&pair, 1});
}

// Edges of slopes up to 1/8 between codes 45 and 190, each pixel the mean over its square, blurred by `blur` px.
EdgeStatistics EdgesOf(const sim::SensorParams& sensor, double blur = 0) {
  const std::vector<double> linear = LinearOf(sensor);
  std::vector<Edge> edges;
  for (int chart = 0; chart < 3; ++chart) {
    sim::RadianceImage radiance{kWidth, kHeight, {}};
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const double place = std::remainder(i % kWidth - (0.02 + 0.05 * chart) * (i / kWidth), 64.0);  // 0 and 32
      double share = 0;
      for (const double part : {-3.5, -2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5})
        share += std::clamp(16.5 - std::abs(place) + blur * part / 8, 0.0, 1.0) / 8;
      radiance.rgb.insert(radiance.rgb.end(), 3, static_cast<float>(std::lerp(linear[45], linear[190], share)));
    }
    const std::vector<Edge> found = FindEdges(Capture(sensor, std::move(radiance), chart));
    edges.insert(edges.end(), found.begin(), found.end());
  }
  return Summarise(edges);
}

// Shot and read noise by linear least squares: with v the variance of a level over the squared slope of code by light,
// (light / full_well + (read_noise / full_well)^2) / v = 1. Returns the rms of half the log of the left side.
double FitNoise(const std::vector<NoiseLevel>& levels, sim::SensorParams& sensor) {
  const std::vector<double> linear = LinearOf(sensor);
  Eigen::MatrixX2d A(levels.size(), 2);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto code = static_cast<std::size_t>(std::clamp(levels[i].code, 3.0, 252.0));
    const double v = std::pow(levels[i].sigma * std::max(1e-6, linear[code + 3] - linear[code - 3]) / 6, 2);
    A.row(static_cast<Eigen::Index>(i)) << linear[code] / v, 1 / v;
  }
  // Textures add to the noise: levels far above the model are left out, as long as half of them remain.
  Eigen::Vector2d x;
  Eigen::ArrayXd kept = Eigen::ArrayXd::Ones(A.rows()), misfit;
  for (int round = 0; round < 4; ++round) {
    const Eigen::MatrixX2d W = A.array().colwise() * kept;
    x = (W.transpose() * W).ldlt().solve(W.transpose() * kept.matrix());
    if (x(1) < 0) x = {W.col(0).sum() / W.col(0).squaredNorm(), 0};
    if (x(0) < 0) x = {1e-8, W.col(1).sum() / W.col(1).squaredNorm()};
    misfit = 0.5 * (A * x).array().log();
    const Eigen::ArrayXd next = (misfit > -0.2).cast<double>();
    if (next.sum() < std::max(3.0, 0.5 * static_cast<double>(A.rows()))) break;
    if (round < 3) kept = next;
  }
  sensor.full_well_e = std::clamp(1 / x(0), 1.0, 1e8);
  sensor.read_noise_e = std::min(std::sqrt(x(1)), 0.25) * sensor.full_well_e;
  return std::sqrt((kept * misfit.square()).sum() / kept.sum());
}

// sRGB; or linear, where that alone explains the noise; or sRGB with toe and shoulder, where these fit clearly better.
double FitResponse(const std::vector<NoiseLevel>& levels, sim::SensorParams& sensor) {
  double best = 1e9, good = 0.08;
  const auto attempt = [&](sim::Response response, double toe, double shoulder, double enough) {
    sim::SensorParams tried = sensor;
    tried.response = response, tried.processing.toe = toe, tried.processing.shoulder = shoulder;
    const double misfit = FitNoise(levels, tried);
    if (misfit < std::min(best, enough)) best = misfit, sensor = tried;
  };
  attempt(sim::Response::srgb, 1, 1, best);
  if (best > good) attempt(sim::Response::linear, 1, 1, good);
  const double clearly = 0.7 * best;
  for (int i = 0; best > good && levels.size() > 5 && i < 15 * 15; ++i)
    attempt(sim::Response::srgb, 0.6 * std::pow(1.1, i / 15), 0.6 * std::pow(1.1, i % 15), clearly);
  return best;
}

// Bisection of a setting for the measured value of a statistic that increases with it.
void Solve(double& setting, double most, double measured, const std::function<double()>& statistic) {
  double low = 0, high = most;
  for (int i = 0; i < 8; ++i) {
    setting = 0.5 * (low + high);
    (statistic() < measured ? low : high) = setting;
  }
  if (low == 0) setting = 0;
}

double Correlation(const NoiseStatistics& noise) { return 0.5 * (noise.correlation[0] + noise.correlation[1]); }

// Noise at a code, as NoiseLevel::sigma; 0 where too much of it is clipped.
double SigmaAt(const sim::SensorParams& sensor, double code) {
  const std::vector<NoiseLevel> levels = FlatAt(sensor, code).levels;
  return levels.empty() ? 0 : std::ranges::max_element(levels, {}, &NoiseLevel::blocks)->sigma;
}

}  // namespace

CameraFit FitCamera(const Recording& recording) {
  constexpr double kHalo = 0.05, kCorrelation = 0.12;  // thresholds above the effect of textures and chance
  CameraFit fit;
  sim::SensorParams& s = fit.sensor;
  sim::ProcessingParams& p = s.processing;
  p.sharpen_sigma_px = 1.5, p.denoise_range = 0.1;
  fit.noise = MeasureNoise(recording.pairs);
  std::erase_if(fit.noise.levels, [](const NoiseLevel& level) { return level.code < 10 || level.code > 245; });
  s.color = recording.pairs.front().picture.channels() == 3;
  if (s.color && std::abs(std::log(fit.noise.lattice)) > 0.2) s.mosaic = sim::Mosaic::demosaiced;
  fit.exposure_s = FitExposure(recording, fit.edges);
  fit.noise_known = fit.noise.levels.size() >= 3 && fit.noise.blocks >= 60;
  fit.edges_known = fit.edges.count >= 200;
  std::vector<NoiseLevel> before = fit.noise.levels;  // mosaic, denoising and sharpening
  bool denoised = false, sharpened = false;
  for (int round = 0; round < 5; ++round) {
    if (fit.noise_known) {
      fit.noise_misfit = FitResponse(before, s);
      if (round == 1) denoised = Correlation(fit.noise) - Correlation(FlatAt(s, 128)) > kCorrelation;
      if (denoised) Solve(p.denoise_sigma_px, 2, Correlation(fit.noise), [&] { return Correlation(FlatAt(s, 128)); });
    }
    if (fit.edges_known) {
      Solve(s.optics.psf_sigma_px, 2, fit.edges.width, [&] { return EdgesOf(s).width; });
      if (round == 0) sharpened = fit.edges.bright + fit.edges.dark - EdgesOf(s).bright - EdgesOf(s).dark > 2 * kHalo;
      if (sharpened) Solve(p.sharpen_bright, 4, fit.edges.bright, [&] { return EdgesOf(s).bright; });
      if (sharpened) Solve(p.sharpen_dark, 4, fit.edges.dark, [&] { return EdgesOf(s).dark; });
    }
    sim::SensorParams plain = s;
    plain.mosaic = sim::Mosaic::none;
    plain.processing.denoise_sigma_px = plain.processing.sharpen_bright = plain.processing.sharpen_dark = 0;
    for (std::size_t i = 0; fit.noise_known && i < before.size(); ++i) {
      const double code = before[i].code, shown = SigmaAt(s, code), unprocessed = SigmaAt(plain, code);
      if (shown > 0 && unprocessed > 0) before[i].sigma = fit.noise.levels[i].sigma * unprocessed / shown;
    }
  }
  if (fit.noise_misfit > 0.25 || p.denoise_sigma_px > 1.9) {  // noise unlike the model's, as of compressed pictures
    fit.noise_known = false;
    s.processing = {.sharpen_bright = p.sharpen_bright, .sharpen_dark = p.sharpen_dark, .sharpen_sigma_px = 1.5};
    s.response = sim::Response::srgb;
  }
  if (fit.exposure_s && fit.edges_known) {  // what the chart's edges gain in width by a blur, beside the fit's kBlur
    const double L = fit.edges.width, gain = std::pow(EdgesOf(s, L).width, 2) - std::pow(EdgesOf(s).width, 2);
    fit.exposure_s->value *= L * std::sqrt(kBlur / gain);
  }
  fit.vignetting_2 = FitVignetting(recording, LinearOf(s));
  if (fit.vignetting_2) s.optics.vignetting_2 = fit.vignetting_2->value;
  return fit;
}

}  // namespace vobench
