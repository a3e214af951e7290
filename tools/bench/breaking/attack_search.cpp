#include "tools/bench/breaking/attack_search.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>

#include "tools/judge/evaluation/draws.h"

namespace vobench::breaking {
namespace {

constexpr double kPrecision = 1.02;  // of the norm along a direction
constexpr double kSlack = 1.04;      // that fewer parameters may cost

struct OutOfEvaluations {};

double Norm(const Combination& x) { return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0)); }

Combination Scaled(Combination x, double norm) {
  const double factor = norm / Norm(x);
  for (double& value : x) value *= factor;
  return x;
}

// The norm at which the ray leaves the cube.
double LargestNorm(const Combination& x) { return Norm(x) / *std::ranges::max_element(x); }

std::size_t Changed(const Combination& x) {
  return static_cast<std::size_t>(std::ranges::count_if(x, [](double value) { return value > 0; }));
}

class Search {
 public:
  Search(const AttackOptions& options, const Breaks& breaks) : options_(options), breaks_(breaks) {}

  AttackResult Run() {
    try {
      if (!Start()) return {false, {}, 0, used_};
      Descend();
      // Elsewhere: directions in which a milder combination would be seen, from there as before.
      evaluation::Draws draws(1);
      for (;;) {
        Combination x(options_.parameters);
        for (double& value : x) value = -std::log(draws.Uniform()) * (draws.Uniform() < 0.5);
        if (Norm(x) == 0 || LargestNorm(x) < 0.9 * Norm(best_)) continue;
        x = Scaled(x, 0.9 * Norm(best_));
        if (!Broken(x)) continue;
        best_ = OnGrid(x);
        Descend();
      }
    } catch (const OutOfEvaluations&) {
      return {!best_.empty(), best_, best_.empty() ? 0 : Norm(best_), used_};
    }
  }

 private:
  Combination OnGrid(Combination x) const {
    for (double& value : x) value = std::clamp(std::round(value * options_.grid) / options_.grid, 0.0, 1.0);
    return x;
  }

  bool Broken(const Combination& asked) {
    const Combination x = OnGrid(asked);
    if (const auto known = known_.find(x); known != known_.end())
      return ++repeated_ > 100'000 ? throw OutOfEvaluations() : known->second;
    if (used_ >= options_.evaluations) throw OutOfEvaluations();
    ++used_;
    return known_[x] = breaks_(x);
  }

  // Start: all parameters at their most severe; or else one of a few random combinations.
  bool Start() {
    Combination x(options_.parameters, 1.0);
    evaluation::Draws draws(2);
    for (int tries = 0; tries < 32; ++tries) {
      if (Broken(x)) return best_ = x, true;
      for (double& value : x) value = draws.Uniform() < 0.5 ? 1.0 : 0.0;
    }
    return false;
  }

  // The least norm along a direction that breaks it, to kPrecision, beginning at the best one so far; infinite where
  // none does. A better one is kept.
  double Along(const Combination& direction) {
    const double most = LargestNorm(direction), known = std::min(Norm(best_), most);
    double whole = 0, broken = INFINITY;
    for (double step = 1.1, norm = known; whole == 0 || std::isinf(broken);) {
      if (Broken(Scaled(direction, norm))) {
        broken = norm;
        norm /= step;
        if (broken * options_.grid < 1) break;
      } else {
        whole = norm;
        if (norm >= most) return INFINITY;
        norm = std::min(most, norm * step);
      }
      step *= step;
    }
    while (broken > kPrecision * whole && (broken - whole) * options_.grid > 1) {
      const double middle = (whole + broken) / 2;
      (Broken(Scaled(direction, middle)) ? broken : whole) = middle;
    }
    const Combination x = OnGrid(Scaled(direction, broken));
    if (Norm(x) < Norm(best_)) best_ = x;
    return broken;
  }

  // Removes each parameter that is not needed, the smallest first; the others may grow until the norm is `slack` times
  // as large.
  void Shrink(double slack) {
    std::vector<std::size_t> order(best_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [this](std::size_t i) { return best_[i]; });
    for (const std::size_t i : order) {
      Combination x = best_;
      if (x[i] == 0 || Changed(x) == 1) continue;
      x[i] = 0;
      if (slack > 1) x = OnGrid(Scaled(x, std::min(LargestNorm(x), slack * Norm(best_))));
      if (Broken(x)) best_ = x;
    }
  }

  void Descend() {
    Along(best_);
    Shrink(1);
    Along(best_);
    Turn();
    Shrink(kSlack);
    Along(best_);
  }

  // Search over directions among the changed parameters, by their angles in the positive orthant.
  void Turn() {
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < best_.size(); ++i) {
      if (best_[i] > 0) changed.push_back(i);
    }
    if (changed.size() < 2) return;
    const auto angles = static_cast<unsigned>(changed.size() - 1);
    std::vector<double> at(angles);
    double rest = 0;
    for (std::size_t i = angles; i-- > 0;) {
      rest = std::hypot(rest, best_[changed[i + 1]]);
      at[i] = std::atan2(rest, best_[changed[i]]);
    }
    const std::function<double(const double*)> norm = [&](const double* angle) {
      Combination direction(best_.size());
      double sine = 1;
      for (std::size_t i = 0; i < changed.size(); ++i) {
        direction[changed[i]] = i < angles ? sine * std::cos(angle[i]) : sine;
        if (i < angles) sine *= std::sin(angle[i]);
      }
      const double found = Along(direction);
      return std::isinf(found) ? 2 * std::sqrt(static_cast<double>(best_.size())) : found;
    };
    struct Call {
      const std::function<double(const double*)>& norm;
      std::exception_ptr error;
      nlopt_opt self;
    };
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(nlopt_create(NLOPT_LN_SBPLX, angles),
                                                                           &nlopt_destroy);
    Call call{norm, nullptr, optimiser.get()};
    const auto objective = [](unsigned, const double* x, double*, void* data) {
      Call& self = *static_cast<Call*>(data);
      try {
        return self.norm(x);
      } catch (...) {  // no exception may pass through C
        self.error = std::current_exception();
        nlopt_force_stop(self.self);
        return 0.0;
      }
    };
    nlopt_set_min_objective(optimiser.get(), objective, &call);
    nlopt_set_lower_bounds1(optimiser.get(), 0);
    nlopt_set_upper_bounds1(optimiser.get(), std::numbers::pi / 2);
    nlopt_set_initial_step1(optimiser.get(), 0.35);
    nlopt_set_xtol_abs1(optimiser.get(), 0.02);
    nlopt_set_maxeval(optimiser.get(), 30 * static_cast<int>(angles));
    double least = 0;
    nlopt_optimize(optimiser.get(), at.data(), &least);
    if (call.error) std::rethrow_exception(call.error);
  }

  const AttackOptions& options_;
  const Breaks& breaks_;
  Combination best_;
  std::map<Combination, bool> known_;
  int used_ = 0, repeated_ = 0;
};

}  // namespace

AttackResult SearchAttack(const AttackOptions& options, const Breaks& breaks) { return Search(options, breaks).Run(); }

}  // namespace vobench::breaking
