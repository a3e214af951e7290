// Purpose: how the Gauss-Newton iterations of the filter go down, and when they may stop. The decrement of a step, b' A^-1 b, is its squared
//          length in standard deviations of the posterior.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vo {

constexpr double kLeft = 1e-2;       // distance from the mode that may be left [standard deviations]
constexpr double kOvershoot = 0.25;  // of the slope before the step: a step past the mode by more is taken back
constexpr double kTolerated = 0.1;   // rise of the objective, which the landmarks' relinearisation may cause

// Whether the mode is near enough after a step of this decrement; `former` is that of the step before it, 0 where there was none, of which
// `gone` was gone. The distances to come are taken as a geometric series. Two things that the last two alone would hide: far away Gauss-Newton
// converges faster than it does in the end, so the rate counts as no less than a half; and landmarks follow the pose one step
// behind, so a tiny step after a long one says little: the next has been up to a tenth of the long one. (Without the two, up to
// half a standard deviation was left.)
inline bool Settled(double decrement, double former, double gone, double left) {
  const double rate = former > 0 ? std::clamp(std::sqrt(decrement / former), 0.5, 1.0) : 0.5;
  const double step = std::sqrt(std::max({decrement, gone * gone * former / 64, 0.0}));
  return step * rate < left * (1 - rate);
}

// One search for a mode, whose variables and steps are its caller's. In each iteration, with everything linearised where the last step led:
// TooLong, then Overshot, then Take. `objective` is -2 log density at its mode, up to a constant.
class Descent {
 public:
  // `left`: distance from the mode that may be left [standard deviations].
  explicit Descent(int iterations, double left = kLeft)
      : left_(left), iterations_(iterations), settled_(iterations == 1) {}  // who asks for one step asks for no more

  bool Next() { return iterations_-- > 0; }
  bool last() const { return iterations_ == 0; }
  bool settled() const { return settled_; }

  // The objective rose: half of the step is to be taken back.
  bool TooLong(double objective) {
    const bool rose = objective > best_ + kTolerated;
    if (rose) gone_ *= 0.5;
    return rose;
  }
  // `slope`: b' step. Past the mode: the part of the step, negative, that leads back to where the slope vanishes; asked once for each step.
  std::optional<double> Overshot(double slope) {
    const double slope_before = gone_ * former_;
    if (last() || went_back_ || !(slope < -kOvershoot * slope_before)) return std::nullopt;
    const double back = -slope / (slope - slope_before);
    gone_ *= 1 + back;
    went_back_ = true;
    return back;
  }
  // The best so far, and the decrement of the step from here.
  void Take(double objective, double decrement) {
    best_ = objective;
    settled_ = settled_ || Settled(decrement, former_, gone_, left_);
    former_ = decrement;
    gone_ = 1;
    went_back_ = false;
  }
  // Whether the step from here will be looked at, or is too small to matter: if not it may lead anywhere.
  bool believed() const { return settled_ || !last(); }

 private:
  double left_;
  int iterations_;
  bool settled_;
  double best_ = std::numeric_limits<double>::infinity();
  double former_ = 0;  // decrement of the step before
  double gone_ = 1;    // how much of that step was gone
  bool went_back_ = false;
};

}  // namespace vo
