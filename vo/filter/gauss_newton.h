// Damped Gauss-Newton iteration to the mode of a density, and its test of convergence.
// Step A^-1 b; its decrement b' A^-1 b is its squared length in standard deviations of the posterior.
// Source:  Nocedal & Wright, "Numerical optimization" (2006), sections 3.1 (step length) and 10.3 (Gauss-Newton).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vo {

constexpr double kToleranceSigma = 1e-2;  // distance from the mode that counts as convergence [standard deviations]
constexpr double kOvershoot = 0.25;       // of the slope before the step: beyond it the line search goes back
constexpr double kTolerated = 0.1;        // rise of the objective, which relinearised landmarks may cause
constexpr double kMaxGain = 10;           // decrease of the objective still to come, in decrements; 2 to 3 occur

// Convergence test after a step of this decrement: what remains is a geometric series of rate sqrt(decrement /
// previous_decrement). `previous_decrement`: of the preceding step (0: none); `fraction`: how much of that step was
// taken. The rate is clamped to [0.5, 1], because Gauss-Newton converges faster far from the mode than near it. A step
// counts as no less than an eighth of the one before: landmarks follow the pose one step behind, and a tiny step after
// a long one can be followed by a tenth of the long one.
inline bool Converged(double decrement, double previous_decrement, double fraction, double tolerance_sigma) {
  const double rate = previous_decrement > 0 ? std::clamp(std::sqrt(decrement / previous_decrement), 0.5, 1.0) : 0.5;
  const double step = std::sqrt(std::max({decrement, fraction * fraction * previous_decrement / 64, 0.0}));
  return step * rate < tolerance_sigma * (1 - rate);
}

// Step control of one minimisation. Each linearisation passes CostIncreased, then LineSearch, then Accept.
// `objective`: -2 log density at its mode, up to a constant.
class Descent {
 public:
  // One iteration is one linearisation, without a test of convergence. The iteration ends where the objective will not
  // fall below `stop_if_above`.
  explicit Descent(int iterations, double tolerance_sigma = kToleranceSigma,
                   double stop_if_above = std::numeric_limits<double>::infinity())
      : tolerance_sigma_(tolerance_sigma),
        stop_if_above_(stop_if_above),
        iterations_(iterations),
        converged_(iterations == 1) {}

  bool Next() { return iterations_-- > 0; }
  bool last() const { return iterations_ == 0; }
  bool converged() const { return converged_; }

  // The objective rose: half of the step is to be taken back.
  bool CostIncreased(double objective) {
    const bool rose = objective > best_ + kTolerated;
    if (rose) step_fraction_ *= 0.5;
    return rose;
  }
  // `slope`: b' step. Beyond the mode: the negative share of the step that leads back to slope 0; at most once for each
  // step.
  std::optional<double> LineSearch(double slope) {
    const double slope_before = step_fraction_ * previous_decrement_;
    if (last() || searched_ || !(slope < -kOvershoot * slope_before)) return std::nullopt;
    const double back = -slope / (slope - slope_before);
    step_fraction_ *= 1 + back;
    searched_ = true;
    return back;
  }
  // The best objective so far, and the decrement of the step from there.
  void Accept(double objective, double decrement) {
    best_ = objective;
    converged_ = converged_ || Converged(decrement, previous_decrement_, step_fraction_, tolerance_sigma_);
    previous_decrement_ = decrement;
    step_fraction_ = 1;
    searched_ = false;
  }
  // The step from there is negligible, or another linearisation verifies it.
  bool will_verify() const { return converged_ || !last(); }
  bool finished() const { return converged_ || best_ - kMaxGain * previous_decrement_ > stop_if_above_; }

 private:
  double tolerance_sigma_, stop_if_above_;
  int iterations_;
  bool converged_;
  double best_ = std::numeric_limits<double>::infinity();
  double previous_decrement_ = 0;
  double step_fraction_ = 1;  // how much of the preceding step was taken
  bool searched_ = false;
};

// Minimises the objective of `problem`, which owns the variables and the step:
//   double Linearise()          at the variables; returns the objective
//   double Slope()              b' step there, once for each linearisation
//   void HalveStep()            takes half of the step back, and halves the step
//   void TakeBack(share)        moves by share < 0 of the step, and shortens the step
//   double Solve()              step = A^-1 b; returns the decrement
//   void Accept(objective, predicted_decrease)   the variables are the best so far
//   void Step()                 adds the step to the variables
//   void Restore()              returns to the variables that were accepted last
template <class Problem>
void MinimiseToMode(Problem& problem, Descent& descent) {
  while (descent.Next()) {
    const double objective = problem.Linearise();
    if (descent.CostIncreased(objective)) {
      if (descent.last()) return problem.Restore();
      problem.HalveStep();
      continue;
    }
    if (const auto back = descent.LineSearch(problem.Slope())) {
      problem.TakeBack(*back);
      continue;
    }
    const double decrement = problem.Solve();
    descent.Accept(objective, decrement);
    problem.Accept(objective, descent.will_verify() ? decrement : 0.0);
    if (!descent.will_verify()) return;
    problem.Step();
    if (descent.finished()) return;
  }
}

}  // namespace vo
