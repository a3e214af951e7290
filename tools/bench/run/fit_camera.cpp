#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/bench/camera_fit/camera_fit.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/run/commands.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace {

// 40 pairs, and 4 runs of 20 frames, each second one, all over the sequence.
Recording Read(const std::filesystem::path& sequence) {
  constexpr std::size_t kPairs = 40, kRuns = 4, kRunLength = 40;
  vo::SequenceReader reader(sequence);
  const std::size_t count = reader.size(), run_step = std::max(kRunLength, count / kRuns);
  if (count < 3) throw std::runtime_error(fmt::format("{}: has {} frames, fewer than 3", sequence.string(), count));
  Recording recording;
  Progress progress("reading", static_cast<std::int64_t>(count));
  std::vector<double> periods;
  vo::Frame before;
  for (std::size_t k = 0; const std::optional<vo::Frame> frame = reader.Next(); ++k) {
    if (k > 0) periods.push_back(static_cast<double>(frame->stamp_ns - before.stamp_ns) * 1e-9);
    if (k > 0 && (k - 1) * std::min(kPairs, count) / count != k * std::min(kPairs, count) / count)
      recording.pairs.push_back(MakePair(before.image, frame->image));
    if (k % run_step == 0) recording.runs.emplace_back();
    if (k % run_step < kRunLength && k % 2 == 0) recording.runs.back().push_back(frame->image);
    before = *frame;
    progress.Step();
  }
  recording.period_s = Quantile(periods, 0.5);
  return recording;
}

void Print(const CameraFit& fit) {
  const sim::SensorParams& s = fit.sensor;
  const sim::ProcessingParams& p = s.processing;
  for (const NoiseLevel& l : fit.noise.levels)
    fmt::print("# code {:3.0f}: noise {:.2f}, of {} flat blocks\n", l.code, l.sigma, l.blocks);
  fmt::print(
      "# correlation of neighbours {:.2f} in rows, {:.2f} in columns; lattice of a mosaic {:.2f}\n"
      "# {} edges at rest: 10-90 % width {:.2f} px, halo {:.3f} bright, {:.3f} dark\n",
      fit.noise.correlation[0], fit.noise.correlation[1], fit.noise.lattice, fit.edges.count, fit.edges.width,
      fit.edges.bright, fit.edges.dark);
  for (const auto& [known, what] :
       {std::pair(fit.noise_known,
                  "full_well, read_noise, toe, shoulder, denoise_sigma: too few flat places, or not the "
                  "noise of light and reading (compressed pictures?)"),
        {fit.exposure_s.has_value(), "exposure: no edges that motion blurs visibly"},
        {fit.vignetting_2.has_value(), "vignetting_2: too little moves through the picture"},
        {fit.edges_known, "psf_sigma, sharpen_bright, sharpen_dark: too few edges at rest between flat sides"},
        {false, "white_balance, colour matrix, white, gain: they need a chart of known colours"},
        {false, "rolling_shutter: `vobench track` estimates it"}}) {
    if (!known) fmt::print("# not determined: {}\n", what);
  }
  fmt::print("sensor:\n  color: {}\n", s.color);
  if (s.mosaic == sim::Mosaic::demosaiced) fmt::print("  mosaic: demosaiced\n");
  if (fit.exposure_s)
    fmt::print("  exposure: {:.2f} ms # +- {:.1f}\n", 1e3 * fit.exposure_s->value, 1e3 * fit.exposure_s->sigma);
  if (fit.noise_known)
    fmt::print("  full_well: {:.0f} e # the noise is explained to {:.0f} %\n  read_noise: {:.2f} e\n  response: {}\n",
               s.full_well_e, 100 * fit.noise_misfit, s.read_noise_e,
               s.response == sim::Response::srgb ? "srgb" : "linear");
  std::vector<std::string> optics, processing;  // what is determined
  if (fit.edges_known) optics.push_back(fmt::format("psf_sigma: {:.3f} px", s.optics.psf_sigma_px));
  if (const auto& vignetting = fit.vignetting_2)
    optics.push_back(fmt::format("vignetting_2: {:.3f}", vignetting->value));
  if (fit.noise_known)
    processing.push_back(fmt::format("toe: {:.3f}, shoulder: {:.3f}, denoise_sigma: {:.3f} px, denoise_range: {}",
                                     p.toe, p.shoulder, p.denoise_sigma_px, p.denoise_range));
  if (fit.edges_known)
    processing.push_back(fmt::format("sharpen_bright: {:.3f}, sharpen_dark: {:.3f}, sharpen_sigma: {} px",
                                     p.sharpen_bright, p.sharpen_dark, p.sharpen_sigma_px));
  if (!optics.empty()) fmt::print("  optics: {{{}}}", fmt::join(optics, ", "));
  if (fit.vignetting_2) fmt::print(" # +- {:.3f}", fit.vignetting_2->sigma);
  if (!optics.empty()) fmt::print("\n");
  if (!processing.empty()) fmt::print("  processing: {{{}}}\n", fmt::join(processing, ", "));
}

}  // namespace

void FitCamera(const FitCameraOptions& options) {
  Print(FitCamera(Input([&] { return Read(options.sequence); })));
}

}  // namespace vobench
