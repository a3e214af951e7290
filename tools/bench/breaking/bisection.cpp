#include "tools/bench/breaking/bisection.h"

#include <algorithm>

#include "tools/judge/evaluation/dose_response.h"
#include "tools/judge/evaluation/logistic_dose.h"

namespace vobench::breaking {
namespace {

struct Bracket {
  int whole = -1;   // the last step that is not broken; -1: there is none
  int broken = -1;  // the first that is
};

Bracket BracketOf(std::vector<StepRuns> done) {
  std::ranges::sort(done, {}, &StepRuns::step);
  std::vector<double> shares, weights;
  for (const StepRuns& step : done) {
    shares.push_back(step.runs > 0 ? static_cast<double>(step.broken) / step.runs : 0);
    weights.push_back(step.runs);
  }
  const std::vector<double> fit = evaluation::IsotonicFit(shares, weights);
  Bracket bracket;
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    if (fit[i] >= 0.5 - 1e-12) {
      bracket.broken = done[i].step;
      break;
    }
    bracket.whole = done[i].step;
  }
  return bracket;
}

}  // namespace

std::vector<int> NextSteps(const std::vector<StepRuns>& done, int steps) {
  if (done.empty()) return {0, steps};
  const auto [whole, broken] = BracketOf(done);
  if (whole < 0 || broken < 0 || broken - whole < 2) return {};
  return {whole + (broken - whole) / 2};
}

std::optional<Breaking> FindBreaking(const std::vector<StepRuns>& done, int steps) {
  std::vector<evaluation::BrokenCount> counts;
  for (const StepRuns& step : done) counts.push_back({1.0 * step.step / steps, step.runs, step.broken});
  const auto fit = evaluation::FitLogisticBreak(counts, 0.9);
  if (!fit) return std::nullopt;
  const auto [whole, broken] = BracketOf(done);
  const auto cut = [](double x) { return std::clamp(x, 0.0, 1.0); };
  if (whole < 0) return Breaking{Breaking::End::at_the_mildest, 0, 0, cut(fit->high)};
  if (broken < 0) return Breaking{Breaking::End::not_reached, 1, cut(fit->low), 1};
  const double low = std::min(fit->low, 1.0 * whole / steps), high = std::max(fit->high, 1.0 * broken / steps);
  return Breaking{Breaking::End::inside, cut(fit->at), cut(low), cut(high)};
}

}  // namespace vobench::breaking
