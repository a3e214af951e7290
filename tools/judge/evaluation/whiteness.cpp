#include "tools/judge/evaluation/whiteness.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace evaluation {

NisSummary SummariseNis(const std::vector<FrameRecord>& frames) {
  NisSummary summary;
  double nis = 0, dof = 0;
  std::size_t inside = 0;
  std::vector<double> z;
  std::map<int, Band> bands;
  for (const FrameRecord& frame : frames) {
    if (frame.nis_dof <= 0) continue;
    if (!bands.contains(frame.nis_dof)) bands[frame.nis_dof] = Chi2MeanBand(frame.nis_dof, 1);
    const Band& band = bands[frame.nis_dof];
    inside += frame.nis >= band.low && frame.nis <= band.high;
    nis += frame.nis;
    dof += frame.nis_dof;
    z.push_back((frame.nis - frame.nis_dof) / std::sqrt(frame.nis_dof));  // of constant variance
  }
  summary.frames = z.size();
  if (z.empty()) return summary;
  const Whiteness whiteness = TestWhiteness(z, 5);
  summary.mean_per_dof = nis / dof;
  summary.share_inside = static_cast<double>(inside) / static_cast<double>(z.size());
  summary.whiteness_bound = whiteness.bound;
  summary.autocorrelation = whiteness.autocorrelation;
  return summary;
}

Whiteness TestWhiteness(const std::vector<double>& sequence, int lags) {
  Whiteness result;
  if (sequence.empty()) return result;
  const double n = static_cast<double>(sequence.size());
  result.bound = 1.96 / std::sqrt(n);
  double mean = 0, squares = 0, ljung_box = 0;
  for (const double value : sequence) mean += value / n;
  for (const double value : sequence) {
    const double off = value - mean;
    squares += off * off;
  }
  const auto most = std::min(static_cast<std::size_t>(std::max(lags, 0)), sequence.size() - 1);
  if (!(squares > 0) || most == 0) return result;
  for (std::size_t lag = 1; lag <= most; ++lag) {
    double sum = 0;
    for (std::size_t k = lag; k < sequence.size(); ++k) sum += (sequence[k] - mean) * (sequence[k - lag] - mean);
    const double rho = sum / squares;
    result.autocorrelation.push_back(rho);
    ljung_box += n * (n + 2) * rho * rho / (n - static_cast<double>(lag));
  }
  result.p_value = Chi2Survival(ljung_box, static_cast<double>(most));
  return result;
}

WhitenessVerdict TestWhiteness(const std::vector<std::vector<double>>& sequences, int lags, double false_alarm) {
  WhitenessVerdict verdict;
  std::vector<std::size_t> with_lag;
  for (const auto& sequence : sequences) {
    const Whiteness run = TestWhiteness(sequence, lags);
    if (run.autocorrelation.empty()) continue;
    ++verdict.runs;
    verdict.rejected += run.p_value < 0.05;
    if (verdict.mean_autocorrelation.size() < run.autocorrelation.size()) {
      verdict.mean_autocorrelation.resize(run.autocorrelation.size());
      with_lag.resize(run.autocorrelation.size());
    }
    for (std::size_t l = 0; l < run.autocorrelation.size(); ++l) {
      verdict.mean_autocorrelation[l] += run.autocorrelation[l];
      ++with_lag[l];
    }
  }
  for (std::size_t l = 0; l < with_lag.size(); ++l) verdict.mean_autocorrelation[l] /= static_cast<double>(with_lag[l]);
  verdict.most_allowed = BinomialLimit(verdict.runs, 0.05, false_alarm);
  verdict.pass = verdict.rejected <= verdict.most_allowed;
  return verdict;
}

NisMeanVerdict TestNisMean(const std::vector<std::vector<double>>& nis, const std::vector<std::vector<int>>& dof,
                           double tolerance, double false_alarm) {
  if (nis.size() != dof.size()) throw std::logic_error("NIS: a run without its degrees of freedom");
  std::vector<double> means;
  for (std::size_t m = 0; m < nis.size(); ++m) {
    if (nis[m].size() != dof[m].size()) throw std::logic_error("NIS: a value without its degrees of freedom");
    double sum = 0, degrees = 0;
    for (std::size_t k = 0; k < nis[m].size(); ++k) {
      if (dof[m][k] <= 0) continue;
      sum += nis[m][k];
      degrees += dof[m][k];
    }
    if (degrees > 0) means.push_back(sum / degrees);
  }
  NisMeanVerdict verdict;
  verdict.runs = means.size();
  for (const double mean : means) verdict.per_dof += mean / static_cast<double>(means.size());
  if (means.size() < 6) {  // too few for a standard deviation
    verdict.runs = 0;
    return verdict;
  }
  double squares = 0;
  for (const double mean : means) squares += (mean - verdict.per_dof) * (mean - verdict.per_dof);
  const auto n = static_cast<double>(means.size());
  verdict.standard_error = std::sqrt(squares / (n * (n - 1)));
  const double half = tolerance + StudentQuantile(1 - false_alarm / 2, n - 1) * verdict.standard_error;
  verdict.low = 1 - half;
  verdict.high = 1 + half;
  verdict.pass = verdict.per_dof >= verdict.low && verdict.per_dof <= verdict.high;
  return verdict;
}

}  // namespace evaluation
