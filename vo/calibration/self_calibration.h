// Self-calibration during the odometry, from the tracks of the first windows of frames: the shutter's readout time,
// where it is not stated, and the focal length.
// Source:  docs/calibration.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/result.h"
#include "vo/calibration/window_fit.h"
#include "vo/geometry/camera.h"

namespace vo {

struct CalibrationEstimate {
  std::optional<Measured> readout_s;     // none: stated, or unknown
  double readout_used_s = 0;             // at the end
  std::optional<Measured> focal_factor;  // estimated factor on the stated focal length
  double pattern_px = 0;  // rms residual at the stated focal length that neither poses nor landmarks absorb

  // Whether the focal length is wrong by more than kWrongFocal, with 97.5 % confidence.
  bool focal_is_wrong() const;
};

constexpr double kConfidence95 = 1.96;  // [sigma]
constexpr double kWrongFocal = 0.02;

// Mean of measurements that may differ by more than their standard deviations.
// Source:  DerSimonian & Laird 1986: random effects, by the method of moments.
Measured RandomEffectsMean(std::span<const Measured> measured);

class SelfCalibration {
 public:
  // `readout_s`: as stated; none: a global shutter at first, and estimated.
  SelfCalibration(const Camera& camera, std::optional<double> readout_s)
      : camera_(camera), stated_(readout_s), readout_s_(readout_s.value_or(0)) {}

  // Whether the frames so far may have to be tracked again: the readout time is not estimated yet.
  bool starting() const { return !stated_ && readouts_.empty() && windows_ < kStartWindows; }
  // A frame and its answer. True where it completes the fit of a window, or of the first part of one: at once while
  // starting, else one round a frame.
  bool Add(std::int64_t stamp_ns, const Pose& pose, std::span<const FeatureView> features);
  bool EndFit();  // all rounds of the present one, if any; returns whether there was one
  // The readout time from now on, where it differs significantly from that in use.
  std::optional<double> ChangeReadout();
  // The same without any frames, with the present readout time.
  SelfCalibration Restarted() const;

  CalibrationEstimate Estimate();  // ends the fit

 private:
  void SetPeriod();
  bool FitEarly();

  static constexpr std::size_t kWindowFrames = 30, kEarliest = 10, kEarlyStep = 5;
  static constexpr int kStartWindows = 3, kMostWindows = 40;
  static constexpr std::size_t kEnough = 8;  // windows that determine a parameter

  Camera camera_;
  bool stated_;
  double readout_s_;
  double period_s_ = 0;  // between frames, mean of the frames last fitted
  int windows_ = 0;
  std::vector<TrackedFrame> frames_;      // of the present window
  std::optional<WindowFitting> fitting_;  // of the one before
  std::optional<Measured> early_;         // readout time, until the first window gives one
  std::vector<Measured> readouts_, log_focals_;
  double px_of_focal_ = 0;  // sum over log_focals_
};

}  // namespace vo
