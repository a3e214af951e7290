#include "sim/motion/gait.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random/random.h"

namespace sim {
namespace {

#include "sim/motion/gait_table.inc"

double FrequencyOf(int component) { return kGaitLowest_hz * std::exp2(0.5 * component); }

// Two equal resonators in a row, in steps of kGaitStep_s.
struct Filter {
  explicit Filter(double hz) {
    const double w = 2 * std::numbers::pi * hz * kGaitStep_s, decay = std::exp(-kGaitDamping * w);
    first = 2 * decay * std::cos(w * std::sqrt(1 - kGaitDamping * kGaitDamping));
    second = -decay * decay;
  }
  template <class T>
  struct State {
    T a1{0.0}, a2{0.0}, b1{0.0}, b2{0.0};
  };
  template <class T>
  T Step(State<T>& s, const T& in) const {
    const T a = first * s.a1 + second * s.a2 + in, b = first * s.b1 + second * s.b2 + a;
    s = {a, s.a1, b, s.b1};
    return b;
  }
  // Of what comes out, its second difference over the step squared, for white noise of variance 1.
  double AccelerationRms(double hz) const {
    State<double> s;
    double x1 = 0, x2 = 0, sum = 0;
    const int steps = static_cast<int>(4 / (kGaitDamping * hz * kGaitStep_s));  // until e^-25
    for (int k = 0; k < steps; ++k) {
      const double x = Step(s, k == 0 ? 1.0 : 0.0), a = (x - 2 * x1 + x2) / (kGaitStep_s * kGaitStep_s);
      sum += a * a;
      x2 = x1, x1 = x;
    }
    return std::sqrt(sum);
  }
  double first = 0, second = 0;
};

// Makes the components below 0.3 Hz no more than the share `most` of what the others leave of the rate, and returns what is
// left for the course.
double Share(double rms, double effort, double most, std::array<double, kGaitComponents>& accelerations) {
  constexpr std::size_t kLow = 2;  // components
  const double all = rms * std::exp(0.5 * effort * effort);
  double low = 0, high = 0;
  for (std::size_t j = 0; j < accelerations.size(); ++j) {
    const double rate = accelerations[j] / (2 * std::numbers::pi * FrequencyOf(static_cast<int>(j)));
    (j < kLow ? low : high) += rate * rate;
  }
  const double rest = std::max(all * all - high, 0.04 * all * all),
               part = std::min(1.0, most * rest / std::max(low, 1e-30));
  for (std::size_t j = 0; j < kLow; ++j) accelerations[j] *= std::sqrt(part);
  return std::sqrt(rest - part * low);
}

double Total(double of_motion, double scale, double of_tremor, double tremor) {
  return std::hypot(of_motion * scale, of_tremor * tremor);
}

}  // namespace

const GaitTable& TableOf(GaitModel model) { return model == GaitModel::handheld ? kHandheld : kDrone; }

Gait::Gait(const GaitParams& p, double from_hz)
    : table_(TableOf(p.model)),
      speed_(p.speed.value_or(table_.speed)),
      turn_rate_(p.turn_rate.value_or(table_.turn_rate)) {
  for (int j = 0; j < kGaitComponents; ++j) {
    if (FrequencyOf(j) < from_hz) continue;
    const auto i = static_cast<std::size_t>(j);
    linear_[i] = Total(table_.linear[i], speed_ * p.vehemence, table_.linear_tremor[i], p.tremor);
    angular_[i] = Total(table_.angular[i], turn_rate_ * p.vehemence, table_.angular_tremor[i], p.tremor);
  }
  // The mean length of a normal vector with three equal components; surfaces take 4 % of the speed.
  constexpr double kMeanOverRms = 0.92, kMeanSpeedOverRms = 0.88;
  course_speed_ = Share(speed_ / kMeanSpeedOverRms, table_.effort, 0.2, linear_);
  course_turn_rate_ = Share(turn_rate_ / kMeanOverRms, table_.effort, 0.5, angular_);
}

std::vector<Offset> Gait::Draw(std::uint64_t seed, std::size_t count) const {
  // The filters begin at rest, early enough to have forgotten it.
  constexpr double kForgotten = 5;  // e-folds
  const auto early =
      static_cast<std::size_t>(kForgotten / (kGaitDamping * 2 * std::numbers::pi * kGaitLowest_hz * kGaitStep_s));
  std::vector<double> drive(early + count);
  std::vector<Offset> offsets(count);
  const double keep = std::exp(-kGaitStep_s / table_.burst_s), gain = std::sqrt(1 - keep * keep);
  const auto factor = [](double s, double level) { return std::exp(s * level - s * s); };  // its square has mean 1
  double burst = 0;
  LowPass<double> effort;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    const auto [a, b] = Normals(RandomWords(seed, Stream::gait_burst, static_cast<std::uint32_t>(k), 0, 0));
    burst = keep * burst + gain * a;
    effort.Step(table_.effort_hz, b);
    const double lasting = factor(table_.effort, effort.rate);
    drive[k] = lasting * factor(table_.burst, burst);
    if (k >= early) offsets[k - early].effort = lasting;
  }
  for (int j = 0; j < kGaitComponents; ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (!(linear_[i] > 0 || angular_[i] > 0)) continue;
    const Filter filter(FrequencyOf(j));
    const double unit = 1 / (std::sqrt(3.0) * filter.AccelerationRms(FrequencyOf(j)));
    Filter::State<glm::dvec3> move, turn;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      const auto [a, b] =
          NormalVectors(seed, Stream::gait, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(j));
      const glm::dvec3 p = filter.Step(move, unit * linear_[i] * drive[k] * a),
                       r = filter.Step(turn, unit * angular_[i] * drive[k] * b);
      if (k < early) continue;
      offsets[k - early].move += p;
      offsets[k - early].turn += r;
    }
  }
  return offsets;
}

}  // namespace sim
