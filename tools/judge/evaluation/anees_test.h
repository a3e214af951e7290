// Test of average NEES (ANEES) over time: the share of frames whose ANEES over runs is inside its two-sided 95 % band,
// compared with that of an exact linear Kalman filter. Frames of one run are dependent: the share varies
// far more than a binomial of 0.95.
//
// Source: Bar-Shalom et al., 5.4; docs/metrics.md, "ANEES as pass or fail".
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evaluation {

// Per axis (position, velocity), position measured, nearly constant velocity: F = [1 dt; 0 1], Q = psd [dt^3/3 dt^2/2;
// dt^2/2 dt]; exact, and in its steady state from the first frame on.
struct LinearFilter {
  enum class Judged { position, velocity, both };
  int axes = 3;  // independent ones; degrees of freedom: axes, or twice as many for `both`
  Judged judged = Judged::position;
  double dt = 1.0 / 30;          // [s]
  double psd = 2.5 * 2.5;        // of acceleration [m^2/s^3]
  double sigma_position = 0.01;  // of the estimate, in the steady state [m]: sets the noise of the measurement
  int dof() const { return judged == Judged::both ? 2 * axes : axes; }
};

// Standard deviation of the measurement that leaves the stated steady-state sigma_position [m].
double MeasurementSigma(const LinearFilter& filter);

// NEES of one set of runs, [run][frame]; a function of (seed, trial).
std::vector<std::vector<double>> SimulateNees(const LinearFilter& filter, int runs, int frames, std::uint64_t seed,
                                              std::uint64_t trial);

// Of consistent filters: share and mean (ShareInBand) of each of `trials` sets of runs, each in ascending order.
struct ExactAnees {
  std::vector<double> shares, means;
};
ExactAnees ExactAneesOf(const LinearFilter& filter, int runs, int frames, int trials = 500, std::uint64_t seed = 1);

// The same from a pool of consistent runs, nees[run][frame]: each trial draws `runs` of them without replacement, so
// that each trial is a set of independent runs; trials share runs, the less the larger the pool: ten times `runs` or
// more. For exact filters that cost more than one axis, as the linearised point world of cramer_rao.h.
ExactAnees ExactAneesOfPool(const std::vector<std::vector<double>>& nees, int dof, int runs, int trials = 1000,
                            std::uint64_t seed = 1);

struct AneesShare {
  std::size_t frames = 0;       // with at least one value
  double share = 0;             // of these, inside the band of as many runs as have a value there
  double above = 0, below = 0;  // shares outside: over-confident, under-confident
  double mean = 0;              // ANEES per degree of freedom, over frames
};
// nees[run][frame]; NaN is left out; runs may differ in length.
AneesShare ShareInBand(const std::vector<std::vector<double>>& nees, int dof);

// Share and mean are two tests, each with the stated false-alarm rate. Where errors drift, an exact filter's share may
// be near zero in one of a hundred sets; with a threshold of 0 the share rejects nothing, and only the mean has power.
struct AneesVerdict {
  AneesShare measured;
  double threshold = 0;  // the false-alarm quantile of an exact filter's share
  double expected = 0;   // its median
  bool share_pass = false;
  double mean_low = 0, mean_high = 0;  // quantiles false_alarm / 2 from either end of an exact filter's mean
  bool mean_pass = false;
  double false_alarm = 0;  // of each
  bool pass() const { return share_pass && mean_pass; }
};
// exact: of as many runs and frames and as many degrees of freedom, at least 2 / false_alarm trials
// (std::invalid_argument).
AneesVerdict TestAnees(const std::vector<std::vector<double>>& nees, int dof, const ExactAnees& exact,
                       double false_alarm = 0.01);

}  // namespace evaluation
