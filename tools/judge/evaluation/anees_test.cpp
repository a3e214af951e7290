#include "tools/judge/evaluation/anees_test.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

#include "tools/judge/evaluation/consistency.h"
#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// The error of one axis: e_t = A e_t-1 + N noise, with covariance P at every t.
struct SteadyState {
  double variance;  // of the measurement
  Matrix2d P, A, N;
};

// The filter's gain is (alpha, beta / dt). Of P = (I - K H) M and M = F P F' + Q, both steady, remain
//   alpha^2 + alpha beta - 2 beta + beta^2 / 6 = 0   and   variance beta^2 / (1 - alpha) = psd dt^3,
// and P(0, 0) = alpha variance is the required one (Bar-Shalom et al., 6.5).
SteadyState SteadyStateOf(const LinearFilter& filter) {
  const bool valid = filter.axes > 0 && filter.dt > 0 && filter.psd > 0 && filter.sigma_position > 0;
  if (!valid) throw std::invalid_argument("LinearFilter: axes, dt, psd and sigma_position must be positive");
  const double dt = filter.dt;
  const auto alpha_of = [](double beta) { return (std::sqrt(beta * beta / 3 + 8 * beta) - beta) / 2; };
  const double wanted = filter.psd * dt * dt * dt / (filter.sigma_position * filter.sigma_position);
  double low = 0, high = 3 - std::sqrt(3.0);  // there alpha is 1
  double beta{}, alpha{}, last{};
  do {
    last = beta;
    beta = (low + high) / 2;
    alpha = alpha_of(beta);
    (beta * beta / alpha / (1 - alpha) < wanted ? low : high) = beta;
  } while (beta != last);
  const double variance = filter.sigma_position * filter.sigma_position / alpha;
  SteadyState state{variance, {}, {}, {}};
  const double across = variance * beta / dt;
  state.P << variance * alpha, across, across, across / dt * (alpha - beta / 2) / (1 - alpha);
  Matrix2d F, Q, keep;
  F << 1, dt, 0, 1;
  Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  keep << 1 - alpha, 0, -beta / dt, 1;
  const Vector2d K(alpha, beta / dt);
  state.A = keep * F;
  state.N = (filter.psd * keep * Q * keep.transpose() + variance * K * K.transpose()).llt().matrixL();
  return state;
}

// Adds one run's NEES to `sums`, one of each frame.
void AddRun(const LinearFilter& filter, const SteadyState& state, Draws& random, std::span<double> sums) {
  const Matrix2d start = state.P.llt().matrixL();
  const Matrix2d inverse = state.P.inverse();
  const auto nees = [&](const Vector2d& e) {
    switch (filter.judged) {
      case LinearFilter::Judged::position:
        return e[0] * e[0] / state.P(0, 0);
      case LinearFilter::Judged::velocity:
        return e[1] * e[1] / state.P(1, 1);
      case LinearFilter::Judged::both:
        break;
    }
    return e.dot(inverse * e);
  };
  for (int axis = 0; axis < filter.axes; ++axis) {
    Vector2d e = start * Vector2d{random.Normal(), random.Normal()};
    for (double& sum : sums) {
      sum += nees(e);
      e = state.A * e + state.N * Vector2d{random.Normal(), random.Normal()};
    }
  }
}

// Share and mean of each trial; add_runs(trial, sums) adds the NEES of its runs, frame by frame.
template <class AddRuns>
ExactAnees OverTrials(int runs, std::size_t frames, int trials, int dof, const AddRuns& add_runs) {
  if (runs < 1 || frames < 1 || trials < 1)
    throw std::invalid_argument("ANEES of an exact filter: needs at least one run, frame and trial");
  const Band band = Chi2MeanBand(dof, runs);
  ExactAnees exact;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> sums(frames);
    add_runs(static_cast<std::uint64_t>(trial), sums);
    double inside = 0, mean = 0;
    for (const double sum : sums) {
      inside += sum / runs >= band.low && sum / runs <= band.high;
      mean += sum / runs / dof;
    }
    exact.shares.push_back(inside / static_cast<double>(frames));
    exact.means.push_back(mean / static_cast<double>(frames));
  }
  std::sort(exact.shares.begin(), exact.shares.end());
  std::sort(exact.means.begin(), exact.means.end());
  return exact;
}

std::uint64_t StreamOf(std::uint64_t trial, int run) { return (trial << 24) + static_cast<std::uint64_t>(run); }

}  // namespace

double MeasurementSigma(const LinearFilter& filter) { return std::sqrt(SteadyStateOf(filter).variance); }

std::vector<std::vector<double>> SimulateNees(const LinearFilter& filter, int runs, int frames, std::uint64_t seed,
                                              std::uint64_t trial) {
  if (runs < 1 || frames < 1) throw std::invalid_argument("SimulateNees: needs at least one run and frame");
  const SteadyState state = SteadyStateOf(filter);
  std::vector<std::vector<double>> nees(static_cast<std::size_t>(runs),
                                        std::vector<double>(static_cast<std::size_t>(frames)));
  for (int m = 0; m < runs; ++m) {
    Draws random(seed, StreamOf(trial, m));
    AddRun(filter, state, random, nees[static_cast<std::size_t>(m)]);
  }
  return nees;
}

ExactAnees ExactAneesOf(const LinearFilter& filter, int runs, int frames, int trials, std::uint64_t seed) {
  const SteadyState state = SteadyStateOf(filter);
  return OverTrials(runs, static_cast<std::size_t>(std::max(frames, 0)), trials, filter.dof(),
                    [&](std::uint64_t trial, std::vector<double>& sums) {
                      for (int m = 0; m < runs; ++m) {
                        Draws random(seed, StreamOf(trial, m));
                        AddRun(filter, state, random, sums);
                      }
                    });
}

ExactAnees ExactAneesOfPool(const std::vector<std::vector<double>>& nees, int dof, int runs, int trials,
                            std::uint64_t seed) {
  for (const auto& run : nees) {
    if (run.size() != nees.front().size() ||
        std::any_of(run.begin(), run.end(), [](double v) { return std::isnan(v); }))
      throw std::invalid_argument("ExactAneesOfPool: runs must be of one length, without gaps");
  }
  if (nees.size() < static_cast<std::size_t>(runs))
    throw std::invalid_argument("ExactAneesOfPool: the pool has fewer runs than a trial");
  std::vector<std::size_t> order(nees.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  return OverTrials(runs, nees.empty() ? 0 : nees.front().size(), trials, dof,
                    [&](std::uint64_t trial, std::vector<double>& sums) {
                      Draws random(seed, trial);
                      for (std::size_t m = 0; m < static_cast<std::size_t>(runs); ++m) {
                        const auto left = static_cast<double>(order.size() - m);
                        std::swap(order[m], order[m + static_cast<std::size_t>(random.Uniform() * left)]);
                        const auto& run = nees[order[m]];
                        std::transform(run.begin(), run.end(), sums.begin(), sums.begin(), std::plus<>());
                      }
                    });
}

AneesShare ShareInBand(const std::vector<std::vector<double>>& nees, int dof) {
  AneesShare share;
  for (const AneesPoint& point : AneesByFrame(nees, dof)) {
    ++share.frames;
    share.mean += point.anees / dof;
    share.above += point.anees > point.band.high;
    share.below += point.anees < point.band.low;
  }
  if (share.frames == 0) return share;
  const auto n = static_cast<double>(share.frames);
  share.mean /= n;
  share.above /= n;
  share.below /= n;
  share.share = 1 - share.above - share.below;
  return share;
}

AneesVerdict TestAnees(const std::vector<std::vector<double>>& nees, int dof, const ExactAnees& exact,
                       double false_alarm) {
  const std::size_t n = std::min(exact.shares.size(), exact.means.size());
  // P(an exact filter is below the k-th smallest of n, counted from 1) = k / (n + 1).
  const auto order = [&](double rate) {
    return static_cast<std::size_t>(std::floor(rate * (static_cast<double>(n) + 1) * (1 + 1e-12)));
  };
  if (order(false_alarm / 2) < 1) {
    throw std::invalid_argument("TestAnees: " + std::to_string(n) + " trials of the exact filter are too few for a " +
                                "false-alarm rate of " + std::to_string(false_alarm));
  }
  AneesVerdict verdict;
  verdict.measured = ShareInBand(nees, dof);
  verdict.false_alarm = false_alarm;
  verdict.threshold = exact.shares[order(false_alarm) - 1];
  verdict.expected = exact.shares[n / 2];
  verdict.share_pass = verdict.measured.frames > 0 && verdict.measured.share >= verdict.threshold;
  verdict.mean_low = exact.means[order(false_alarm / 2) - 1];
  verdict.mean_high = exact.means[n - order(false_alarm / 2)];
  const double mean = verdict.measured.mean;
  verdict.mean_pass = verdict.measured.frames > 0 && mean >= verdict.mean_low && mean <= verdict.mean_high;
  return verdict;
}

}  // namespace evaluation
