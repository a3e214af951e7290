#include "sim/motion/carrier_motion.h"

#include <algorithm>

#include "sim/random/random.h"

namespace sim {
namespace {

#include "sim/motion/carrier_motion_table.inc"

constexpr double kDamping = 0.3, kLowest_hz = 0.175;

// [rad/s]
double FrequencyOf(std::size_t component) {
  return 2 * std::numbers::pi * kLowest_hz * std::exp2(0.5 * static_cast<double>(component));
}

// Two equal resonators in a row, in steps of kCarrierStep_s.
template <class T>
struct Resonators {
  explicit Resonators(double w) {
    const double decay = std::exp(-kDamping * w * kCarrierStep_s);
    c1 = 2 * decay * std::cos(w * kCarrierStep_s * std::sqrt(1 - kDamping * kDamping)), c2 = -decay * decay;
  }
  const T& Step(const T& in) {
    const T a = c1 * a1 + c2 * a2 + in, b = c1 * b1 + c2 * b2 + a;
    a2 = a1, a1 = a, b2 = b1, b1 = b;
    return b1;
  }
  double c1, c2;
  T a1{0.0}, a2{0.0}, b1{0.0}, b2{0.0};
};

// Root mean square of the output's second difference over the step squared, for white noise of variance 1.
double AccelerationRms(double w) {
  Resonators<double> resonators(w);
  double x1 = 0, x2 = 0, sum = 0;
  const int steps = static_cast<int>(25 / (kDamping * w * kCarrierStep_s));  // until e^-25
  for (int k = 0; k < steps; ++k) {
    const double x = resonators.Step(k == 0 ? 1.0 : 0.0);
    sum += std::pow((x - 2 * x1 + x2) / (kCarrierStep_s * kCarrierStep_s), 2);
    x2 = x1, x1 = x;
  }
  return std::sqrt(sum);
}

// Limits the components below 0.3 Hz to the share `most` of the rate that the others leave, and returns the remainder
// for the course.
double Share(double rms, double activity, double most, std::array<double, kCarrierComponents>& accelerations) {
  constexpr std::size_t kLow = 2;  // components
  const double all = rms * std::exp(0.5 * activity * activity);
  double low = 0, high = 0;
  for (std::size_t j = 0; j < kCarrierComponents; ++j)
    (j < kLow ? low : high) += std::pow(accelerations[j] / FrequencyOf(j), 2);
  const double rest = std::max(all * all - high, 0.04 * all * all),
               part = std::min(1.0, most * rest / std::max(low, 1e-30));
  for (std::size_t j = 0; j < kLow; ++j) accelerations[j] *= std::sqrt(part);
  return std::sqrt(rest - part * low);
}

}  // namespace

const CarrierMotionTable& TableOf(Carrier model) { return model == Carrier::drone ? kDrone : kHandheld; }

CarrierMotion::CarrierMotion(const CarrierMotionParams& p, double from_hz)
    : table_(TableOf(p.model)),
      speed_(p.speed.value_or(table_.speed)),
      turn_rate_(p.turn_rate.value_or(table_.turn_rate)) {
  for (std::size_t j = 0; j < kCarrierComponents; ++j) {
    if (FrequencyOf(j) < 2 * std::numbers::pi * from_hz) continue;
    linear_[j] = std::hypot(table_.linear[j] * speed_ * p.vehemence, table_.linear_tremor[j] * p.tremor);
    angular_[j] = std::hypot(table_.angular[j] * turn_rate_ * p.vehemence, table_.angular_tremor[j] * p.tremor);
  }
  // The mean length of a normal vector with three equal components; surfaces take 4 % of the speed.
  constexpr double kMeanOverRms = 0.92, kMeanSpeedOverRms = 0.88;
  course_speed_ = Share(speed_ / kMeanSpeedOverRms, table_.activity, 0.2, linear_);
  course_turn_rate_ = Share(turn_rate_ / kMeanOverRms, table_.activity, 0.5, angular_);
}

std::vector<Offset> CarrierMotion::Draw(std::uint64_t seed, std::size_t count) const {
  // The filters begin at rest, five e-folds of the slowest early.
  const auto early = static_cast<std::size_t>(5 / (kDamping * FrequencyOf(0) * kCarrierStep_s));
  std::vector<double> drive(early + count);
  std::vector<Offset> offsets(count);
  const double keep = std::exp(-kCarrierStep_s / table_.burst_s), gain = std::sqrt(1 - keep * keep);
  const auto factor = [](double s, double level) { return std::exp(s * level - s * s); };  // its square has mean 1
  double burst = 0;
  LowPass<double> activity;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    const auto [a, b] = Normals(RandomWords(seed, Stream::carrier_burst, static_cast<std::uint32_t>(k), 0, 0));
    burst = keep * burst + gain * a;
    activity.Draw(table_.activity_hz, b);
    drive[k] = factor(table_.activity, activity.rate) * factor(table_.burst, burst);
    if (k >= early) offsets[k - early].activity = factor(table_.activity, activity.rate);
  }
  for (std::size_t j = 0; j < kCarrierComponents; ++j) {
    if (!(linear_[j] > 0 || angular_[j] > 0)) continue;
    const double unit = 1 / (std::sqrt(3.0) * AccelerationRms(FrequencyOf(j)));
    Resonators<glm::dvec3> move(FrequencyOf(j)), turn(FrequencyOf(j));
    for (std::size_t k = 0; k < drive.size(); ++k) {
      const auto [a, b] =
          NormalVectors(seed, Stream::carrier, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(j));
      const glm::dvec3 p = move.Step(unit * linear_[j] * drive[k] * a),
                       r = turn.Step(unit * angular_[j] * drive[k] * b);
      if (k >= early) offsets[k - early].move += p, offsets[k - early].turn += r;
    }
  }
  return offsets;
}

}  // namespace sim
