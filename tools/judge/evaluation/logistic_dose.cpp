#include "tools/judge/evaluation/logistic_dose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/judge/evaluation/distributions.h"

namespace evaluation {
namespace {

constexpr int kSteps = 800;  // of m
constexpr double kFrom = -0.5, kTo = 1.5, kFlattest = 3, kSteepest = 1000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double LogLikelihood(const std::vector<BrokenCount>& counts, double m, double k) {
  double sum = 0;
  for (const BrokenCount& count : counts) {
    const double x = k * (count.dose - m), log_of_one_plus_exp = std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x)));
    sum += count.broken * x - count.runs * log_of_one_plus_exp;
  }
  return sum;
}

struct Best {
  double log_likelihood, k;
};

// Over k: a grid in its logarithm, then golden sections about its best.
Best Profile(const std::vector<BrokenCount>& counts, double m) {
  constexpr int kGrid = 16;
  const double step = std::log(kSteepest / kFlattest) / kGrid;
  const auto at = [&](double i) { return LogLikelihood(counts, m, kFlattest * std::exp(step * i)); };
  int best = 0;
  for (int i = 1; i <= kGrid; ++i) best = at(i) > at(best) ? i : best;
  double a = std::max(0, best - 1), b = std::min(kGrid, best + 1);
  for (int i = 0; i < 12; ++i) {
    const double third = 0.381966 * (b - a);
    at(a + third) > at(b - third) ? b -= third : a += third;
  }
  const double found = std::max({at(best), at(a), at(b)});
  return {found, kFlattest * std::exp(step * (found == at(a) ? a : found == at(b) ? b : best))};
}

}  // namespace

std::optional<LogisticBreak> FitLogisticBreak(const std::vector<BrokenCount>& counts, double level) {
  if (!(level > 0 && level < 1)) throw std::invalid_argument("the level of an interval is between 0 and 1");
  int runs = 0;
  std::size_t doses = 0;
  for (const BrokenCount& count : counts) {
    if (count.runs < 0 || count.broken < 0 || count.broken > count.runs) {
      throw std::invalid_argument("of no run or more, none to all are broken");
    }
    runs += count.runs;
    doses += count.runs > 0;
  }
  if (runs == 0) return std::nullopt;
  const auto m_of = [](int i) { return kFrom + (kTo - kFrom) * i / kSteps; };
  std::vector<Best> profile;
  double largest = -kInfinity;
  for (int i = 0; i <= kSteps; ++i) {
    profile.push_back(Profile(counts, m_of(i)));
    largest = std::max(largest, profile.back().log_likelihood);
  }
  const auto range = [&](double below) {  // first and last m whose log-likelihood is less by no more than this
    const auto within = [&](const Best& best) { return best.log_likelihood >= largest - below; };
    const auto first = std::find_if(profile.begin(), profile.end(), within);
    const auto last = std::find_if(profile.rbegin(), profile.rend(), within);
    return std::pair(static_cast<int>(first - profile.begin()), static_cast<int>(profile.rend() - last) - 1);
  };
  const auto [begin, end] = range(1e-3);
  const double t = StudentQuantile((1 + level) / 2, static_cast<double>(std::max<std::size_t>(doses, 4) - 2));
  const auto [low, high] = range(t * t / 2);
  LogisticBreak found{m_of(begin) / 2 + m_of(end) / 2, m_of(low), m_of(high),
                      profile[static_cast<std::size_t>((begin + end) / 2)].k};
  if (low == 0) found.low = -kInfinity;
  if (high == kSteps) found.high = kInfinity;
  return found;
}

}  // namespace evaluation
