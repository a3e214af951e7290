#include "tools/judge/evaluation/dose_response.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "tools/judge/evaluation/draws.h"
#include "tools/judge/evaluation/statistics.h"

namespace evaluation {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Values by block and dose, sorted, so that the result does not depend on the order of the runs.
class Blocks {
 public:
  Blocks(std::size_t doses, const std::vector<DoseRun>& runs) : doses_(doses) {
    std::map<std::size_t, std::vector<std::vector<double>>> blocks;
    for (const DoseRun& run : runs) {
      if (run.dose >= doses) throw std::invalid_argument("a run's dose is not one of the doses");
      if (!std::isnan(run.value)) blocks.try_emplace(run.block, doses).first->second[run.dose].push_back(run.value);
    }
    for (auto& [name, block] : blocks) {
      for (auto& values : block) std::sort(values.begin(), values.end());
      values_.push_back(std::move(block));
    }
  }

  std::size_t size() const { return values_.size(); }

  std::vector<std::vector<double>> Together(const std::vector<std::size_t>& blocks) const {
    std::vector<std::vector<double>> pooled(doses_);
    for (const std::size_t block : blocks) {
      for (std::size_t d = 0; d < doses_; ++d) {
        pooled[d].insert(pooled[d].end(), values_[block][d].begin(), values_[block][d].end());
      }
    }
    return pooled;
  }
  std::vector<std::vector<double>> All() const {
    std::vector<std::size_t> each(size());
    std::iota(each.begin(), each.end(), std::size_t{0});
    return Together(each);
  }
  // As many blocks as there are, with replacement: a function of the seed and the number of the resample.
  std::vector<std::vector<double>> Resampled(std::uint64_t seed, std::uint64_t resample) const {
    Draws draws(seed, resample);
    std::vector<std::size_t> drawn(size());
    for (std::size_t& block : drawn) block = static_cast<std::size_t>(draws.Uniform() * static_cast<double>(size()));
    return Together(drawn);
  }

 private:
  std::size_t doses_;
  std::vector<std::vector<std::vector<double>>> values_;  // [block][dose]
};

void Check(const BootstrapOptions& options) {
  if (!(options.level > 0 && options.level < 1)) throw std::invalid_argument("a bootstrap's level is between 0 and 1");
  if (options.resamples < 1) throw std::invalid_argument("a bootstrap needs a resample");
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? kNone : sum / static_cast<double>(values.size());
}

// Ends of the central `level` of the values, both among the values: no arithmetic with infinities.
std::pair<double, double> Percentiles(std::vector<double>& values, double level) {
  if (values.empty()) return {kNone, kNone};
  std::sort(values.begin(), values.end());
  const auto outside = static_cast<std::size_t>(static_cast<double>(values.size()) * (1 - level) / 2);
  return {values[outside], values[values.size() - 1 - outside]};
}

std::vector<DoseEstimate> ByDose(std::size_t doses, const std::vector<DoseRun>& runs, const BootstrapOptions& options,
                                 const std::function<double(const std::vector<double>&)>& of) {
  Check(options);
  const Blocks blocks(doses, runs);
  const auto all = blocks.All();
  std::vector<std::vector<double>> resampled(doses);
  for (int i = 0; i < options.resamples; ++i) {
    const auto drawn = blocks.Resampled(options.seed, static_cast<std::uint64_t>(i));
    for (std::size_t d = 0; d < doses; ++d) {
      if (!drawn[d].empty()) resampled[d].push_back(of(drawn[d]));
    }
  }
  std::vector<DoseEstimate> estimates;
  for (std::size_t d = 0; d < doses; ++d) {
    const auto [low, high] = Percentiles(resampled[d], options.level);
    estimates.push_back({all[d].size(), of(all[d]), low, high});
  }
  return estimates;
}

// The doses about the crossing, as indices: -inf where there is none before it, +inf where there is none after it.
struct Half {
  double unbroken, broken;
  double share{};  // of the way between them, where both are there
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Some dose must have runs.
Half HalfOf(const std::vector<std::vector<double>>& failures) {
  std::vector<double> shares, weights, indices;
  for (std::size_t d = 0; d < failures.size(); ++d) {
    if (failures[d].empty()) continue;
    shares.push_back(Mean(failures[d]));
    weights.push_back(static_cast<double>(failures[d].size()));
    indices.push_back(static_cast<double>(d));
  }
  const std::vector<double> fit = IsotonicFit(shares, weights);
  // One half itself counts; pooled means are rounded.
  const auto broken = std::find_if(fit.begin(), fit.end(), [](double share) { return share >= 0.5 - 1e-12; });
  if (broken == fit.end()) return {indices.back(), kInfinity};
  const auto k = static_cast<std::size_t>(broken - fit.begin());
  if (k == 0) return {-kInfinity, indices.front()};
  return {indices[k - 1], indices[k], std::min(1.0, (0.5 - fit[k - 1]) / (fit[k] - fit[k - 1]))};
}

Crossing AtDose(const std::vector<double>& doses, double index) {
  if (std::isinf(index)) return {std::signbit(index) ? Crossing::Kind::at_the_first : Crossing::Kind::not_reached};
  return {Crossing::Kind::inside, doses[static_cast<std::size_t>(index)]};
}

Crossing Interpolated(const std::vector<double>& doses, const Half& half) {
  if (std::isinf(half.unbroken)) return AtDose(doses, half.unbroken);
  if (std::isinf(half.broken)) return AtDose(doses, half.broken);
  const double from = AtDose(doses, half.unbroken).dose, to = AtDose(doses, half.broken).dose;
  const double dose = AreGeometric(doses) ? from * std::pow(to / from, half.share) : from + half.share * (to - from);
  return {Crossing::Kind::inside, dose};
}

}  // namespace

std::vector<DoseEstimate> MediansByDose(std::size_t doses, const std::vector<DoseRun>& runs,
                                        const BootstrapOptions& options) {
  return ByDose(doses, runs, options, [](const std::vector<double>& values) { return Median(values); });
}

std::vector<DoseEstimate> MeansByDose(std::size_t doses, const std::vector<DoseRun>& runs,
                                      const BootstrapOptions& options) {
  return ByDose(doses, runs, options, Mean);
}

std::vector<double> IsotonicFit(const std::vector<double>& values, const std::vector<double>& weights) {
  if (values.size() != weights.size()) throw std::invalid_argument("each value needs a weight");
  struct Pool {
    double mean, weight;
    std::size_t end;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (weights[i] > 0) {
      pools.push_back({values[i], weights[i], i + 1});
    } else if (!pools.empty()) {
      pools.back().end = i + 1;
    }
    while (pools.size() > 1 && pools[pools.size() - 2].mean >= pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& pool = pools.back();
      pool.mean = (pool.weight * pool.mean + last.weight * last.mean) / (pool.weight + last.weight);
      pool.weight += last.weight;
      pool.end = last.end;
    }
  }
  std::size_t first = 0;
  while (first < weights.size() && !(weights[first] > 0)) ++first;
  std::vector<double> fit(first, kNone);
  for (const Pool& pool : pools) fit.resize(pool.end, pool.mean);
  return fit;
}

bool AreGeometric(const std::vector<double>& doses) {
  if (doses.size() < 2 || *std::min_element(doses.begin(), doses.end()) <= 0) return false;
  const auto spread = [&](const auto& step) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t i = 1; i < doses.size(); ++i) {
      const double size = std::abs(step(doses[i]) - step(doses[i - 1]));
      least = std::min(least, size), most = std::max(most, size);
    }
    return most / least;
  };
  if (doses.size() == 2) return std::max(doses[0] / doses[1], doses[1] / doses[0]) > 2;
  return spread([](double dose) { return std::log(dose); }) < spread([](double dose) { return dose; });
}

std::optional<BreakingPoint> FindBreakingPoint(const std::vector<double>& doses, const std::vector<DoseRun>& failures,
                                               const BootstrapOptions& options) {
  Check(options);
  for (std::size_t i = 1; i < doses.size(); ++i) {
    if (!(doses[1] > doses[0] ? doses[i] > doses[i - 1] : doses[i] < doses[i - 1])) {
      throw std::invalid_argument("doses neither rise nor fall");
    }
  }
  const Blocks blocks(doses.size(), failures);
  if (blocks.size() == 0) return std::nullopt;
  std::vector<double> unbroken, broken;
  for (int i = 0; i < options.resamples; ++i) {
    const Half half = HalfOf(blocks.Resampled(options.seed, static_cast<std::uint64_t>(i)));
    unbroken.push_back(half.unbroken);
    broken.push_back(half.broken);
  }
  const Half found = HalfOf(blocks.All());
  const double low = std::min(Percentiles(unbroken, options.level).first, found.unbroken);
  const double high = std::max(Percentiles(broken, options.level).second, found.broken);
  return BreakingPoint{Interpolated(doses, found), AtDose(doses, low), AtDose(doses, high)};
}

}  // namespace evaluation
