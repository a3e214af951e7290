#include "vo/calibration/self_calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vo {
namespace {

// Of a period between frames: for a shorter readout the correction by the filter's velocity, which is that between
// frames, is no more accurate than none.
constexpr double kLeastReadout = 0.15;
constexpr double kLeastChange = 0.002;  // [s] smaller changes of a readout time in use are negligible
constexpr double kSignificant = 3, kSignificantEarly = 6;  // [sigma]
// Windows of a larger standard deviation are ignored.
constexpr double kWideReadout = 0.005, kWideFocal = 0.05;

}  // namespace

bool CalibrationEstimate::focal_is_wrong() const {
  return focal_factor && std::abs(focal_factor->value - 1) - kConfidence95 * focal_factor->sigma > kWrongFocal;
}

Measured RandomEffectsMean(std::span<const Measured> measured) {
  double between = 0;  // variance
  const auto mean = [&] {
    double sum = 0, weights = 0;
    for (const Measured& m : measured) {
      const double weight = 1 / (m.sigma * m.sigma + between);
      sum += weight * m.value;
      weights += weight;
    }
    return Measured{sum / weights, 1 / std::sqrt(weights)};
  };
  const Measured fixed = mean();
  if (measured.size() < 2) return fixed;
  double excess = 1 - static_cast<double>(measured.size()), squares = 0;
  for (const Measured& m : measured) {
    const double weight = 1 / (m.sigma * m.sigma);
    excess += weight * (m.value - fixed.value) * (m.value - fixed.value);
    squares += weight * weight;
  }
  const double weights = 1 / (fixed.sigma * fixed.sigma);
  between = std::max(0.0, excess / (weights - squares / weights));
  return mean();
}

bool SelfCalibration::Add(std::int64_t stamp_ns, const Pose& pose, std::span<const FeatureView> features) {
  bool completed = fitting_ && !fitting_->Round() && EndFit();
  if (windows_ == kMostWindows || std::max(readouts_.size(), log_focals_.size()) == kEnough) return completed;
  TrackedFrame frame{stamp_ns, pose, {}};
  for (const FeatureView& view : features) {
    if (view.status == FeatureView::Status::matched || view.status == FeatureView::Status::fresh)
      frame.sightings.push_back({view.id, view.pixel, view.R});
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() < kWindowFrames) return FitEarly() || completed;
  completed |= EndFit();
  const bool at_once = starting();
  ++windows_;
  SetPeriod();
  fitting_.emplace(frames_, camera_, readout_s_, !stated_);
  frames_.clear();
  if (at_once) completed |= EndFit();
  return completed;
}

void SelfCalibration::SetPeriod() {
  const std::int64_t duration_ns = frames_.back().stamp_ns - frames_.front().stamp_ns;
  period_s_ = static_cast<double>(duration_ns) * 1e-9 / static_cast<double>(frames_.size() - 1);
}

// The readout time from the first part of a window, since a map begun without one is sheared. Of so few frames a quick
// motion has changes that the fit takes for readout or focal length: its own covariance is too small.
bool SelfCalibration::FitEarly() {
  if (!starting() || readout_s_ != 0 || frames_.size() < kEarliest || frames_.size() % kEarlyStep != 0) return false;
  const std::optional<WindowFit> fit = WindowFitting(frames_, camera_, readout_s_, true).AllRounds();
  const auto significant = [](const Measured& m, double sigmas) { return std::abs(m.value) > sigmas * m.sigma; };
  if (!fit || fit->readout_s.sigma > kWideReadout || !significant(fit->readout_s, kSignificantEarly) ||
      significant(fit->log_focal, kSignificant))
    return false;
  early_ = fit->readout_s;
  SetPeriod();
  return true;
}

bool SelfCalibration::EndFit() {
  if (!fitting_) return false;
  const std::optional<WindowFit> fit = std::exchange(fitting_, std::nullopt)->AllRounds();
  if (fit && !stated_ && fit->readout_s.sigma < kWideReadout) readouts_.push_back(fit->readout_s);
  if (fit && fit->log_focal.sigma < kWideFocal) {
    log_focals_.push_back(fit->log_focal);
    px_of_focal_ += fit->px_of_focal;
  }
  return true;
}

std::optional<double> SelfCalibration::ChangeReadout() {
  if (readouts_.empty() && !early_) return std::nullopt;
  const auto [value, sigma] = readouts_.empty() ? *early_ : RandomEffectsMean(readouts_);
  const double least = readout_s_ == 0 ? kLeastReadout * period_s_ : kLeastChange;
  const double significant = readout_s_ == 0 ? kSignificant * sigma : sigma;
  if (std::abs(value - readout_s_) < std::max(least, significant)) return std::nullopt;
  log_focals_.clear();  // of tracks that another readout time has distorted
  px_of_focal_ = 0;
  return readout_s_ = value;
}

SelfCalibration SelfCalibration::Restarted() const {
  SelfCalibration restarted(camera_, readout_s_);
  restarted.stated_ = stated_;
  restarted.period_s_ = period_s_;
  return restarted;
}

CalibrationEstimate SelfCalibration::Estimate() {
  EndFit();
  CalibrationEstimate out;
  out.readout_used_s = readout_s_;
  if (!readouts_.empty()) out.readout_s = RandomEffectsMean(readouts_);
  if (!log_focals_.empty()) {
    const Measured log_focal = RandomEffectsMean(log_focals_);
    const double factor = std::exp(log_focal.value);
    out.focal_factor = {factor, factor * log_focal.sigma};
    out.pattern_px = px_of_focal_ / static_cast<double>(log_focals_.size()) * std::abs(log_focal.value);
  }
  return out;
}

}  // namespace vo
