#include "tools/judge/evaluation/nis.h"

#include <cmath>
#include <map>

#include "tools/judge/evaluation/distributions.h"

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
    z.push_back((frame.nis - frame.nis_dof) / std::sqrt(frame.nis_dof));  // of equal spread, whatever that is
  }
  summary.frames = z.size();
  if (z.empty()) return summary;
  const double n = static_cast<double>(z.size());
  summary.mean_per_dof = nis / dof;
  summary.share_inside = static_cast<double>(inside) / n;
  summary.whiteness_bound = 1.96 / std::sqrt(n);
  double mean = 0, variance = 0;
  for (const double value : z) mean += value / n;
  for (const double value : z) {
    const double off = value - mean;
    variance += off * off;
  }
  for (std::size_t lag = 1; lag <= 5 && lag < z.size() && variance > 0; ++lag) {
    double sum = 0;
    for (std::size_t k = lag; k < z.size(); ++k) sum += (z[k] - mean) * (z[k - lag] - mean);
    summary.autocorrelation.push_back(sum / variance);
  }
  return summary;
}

}  // namespace evaluation
