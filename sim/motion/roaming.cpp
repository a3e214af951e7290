#include "sim/motion/roaming.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/motion/carrier_motion.h"
#include "sim/motion/path.h"
#include "sim/motion/placement.h"
#include "sim/motion/so3.h"
#include "sim/motion/spline.h"
#include "sim/random/random.h"
#include "tools/base/settings/quantity.h"

namespace sim {
namespace {

constexpr double kStep = kCarrierStep_s, kDegree = std::numbers::pi / 180;

std::size_t KeysUntil(double end_s) { return static_cast<std::size_t>(std::ceil(end_s / kStep)) + 3; }

double YawOf(const glm::dvec3& way) { return std::atan2(-way.x, -way.z); }
double PitchOf(const glm::dvec3& way) { return std::atan2(way.y, std::hypot(way.x, way.z)); }
double Wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }
// Excess of x beyond +-width.
double Beyond(double x, double width) { return x - std::clamp(x, -width, width); }

glm::dquat Turned(const glm::dquat& start, const glm::dvec3& pitch_yaw_roll) {
  return glm::normalize(Exp({0, pitch_yaw_roll.y, 0}) * start * Exp({pitch_yaw_roll.x, 0, 0}) *
                        Exp({0, 0, pitch_yaw_roll.z}));
}

// Level, a little down.
Pose Level() { return {glm::dvec3(0), glm::dquat(0, 1, 0, 0) * Exp({-0.2, 0, 0})}; }

// Where surfaces begin to push [m].
double MarginOf(const CarrierMotion& carrier) { return std::max(0.15, carrier.table().ahead_s * carrier.speed()); }

class Roamer {
 public:
  Roamer(const RoamingMotion& motion, const CarrierMotion& carrier, const Pose& start, const Surroundings* around,
         std::uint64_t seed)
      : m_(motion), carrier_motion_(carrier), start_(start), around_(around), seed_(seed), margin_(MarginOf(carrier)) {
    const glm::dvec3 way = start.q_WC * glm::dvec3(0, 0, 1);
    yaw_0_ = YawOf(way), pitch_0_ = PitchOf(way);
    target_ = {pitch_0_, yaw_0_};
  }

  // Keys, and the smallest excess of a surface's distance over the clearance (below 0: too near) with its time.
  struct Path {
    std::vector<KeyPose> keys;
    double spare = 1e9, spare_s = 0;
    glm::dvec3 place{0.0};
  };

  Path Draw(std::size_t count) {
    const std::vector<Offset> offsets = carrier_motion_.Draw(seed_, count);
    const auto early = static_cast<std::size_t>(2 / (carrier_motion_.table().course_hz * kStep));
    for (std::size_t k = 0; k < early; ++k) StepCourse(k);
    Path path;
    glm::dvec3 course(0.0), angles(0.0), last = start_.p_WC;
    for (std::size_t k = 0; k < count; ++k) {
      const double t_s = kStep * static_cast<double>(k);
      const glm::dvec3 p = start_.p_WC + course + offsets[k].move - offsets[0].move;
      const glm::dvec3 turn = angles + offsets[k].turn - offsets[0].turn;
      path.keys.push_back({t_s, {p, Turned(start_.q_WC, turn)}});
      Avoid(p, glm::distance(p, last), t_s, path);
      Gaze(path.keys.back().pose, turn, t_s);
      last = p;
      StepCourse(early + k);
      course += kStep * (offsets[k].activity * Velocity() + away_.rate);
      angles += kStep * (offsets[k].activity * offsets[k].activity * TurnRate() + gaze_.rate);
    }
    return path;
  }

 private:
  void StepCourse(std::size_t k) {
    const auto [a, b] = NormalVectors(seed_, Stream::carrier_course, static_cast<std::uint32_t>(k), 0);
    moves_.Draw(carrier_motion_.table().course_hz, a);
    turns_.Draw(carrier_motion_.table().course_hz, b);
  }

  glm::dvec3 Velocity() const {
    const glm::dvec3 u = moves_.rate * glm::dvec3(0.686, 0.24, 0.686);  // the vertical is 0.35 of the others
    const double e = carrier_motion_.table().evenness;
    return carrier_motion_.course_speed() * std::sqrt((1 + e) / (e + glm::dot(u, u))) * u;
  }
  // The pitch's is half of the yaw's.
  glm::dvec3 TurnRate() const { return carrier_motion_.course_turn_rate() * turns_.rate * glm::dvec3(0.447, 0.894, 0); }

  void Avoid(const glm::dvec3& p, double step, double t_s, Path& path) {
    glm::dvec3 wanted(0, -Beyond(p.y - start_.p_WC.y, carrier_motion_.table().climb), 0);
    const auto nearest = around_ ? around_->Nearest(p, m_.clearance + step + margin_) : std::nullopt;
    if (nearest) {
      const double distance = glm::distance(p, *nearest), spare = distance - m_.clearance - step;
      if (spare < path.spare) path.spare = spare, path.spare_s = t_s, path.place = p;
      const glm::dvec3 out = (p - *nearest) / std::max(distance, 1e-9);
      const double close = std::clamp(1 - spare / margin_, 0.0, 1.25);
      wanted += 3 * std::max(carrier_motion_.speed(), 0.1) * close * close * close * out;
      for (glm::dvec3* u : {&moves_.first, &moves_.rate}) {
        const double size = glm::length(*u);
        *u -= std::min(1.0, 5 / carrier_motion_.table().ahead_s * kStep * close * close) *
              std::min(0.0, glm::dot(*u, out)) * out;
        *u *= std::min(1.02, size / std::max(glm::length(*u), 1e-9));  // it turns rather than stops
      }
    }
    away_.Step(10 / carrier_motion_.table().ahead_s, wanted);
  }

  // turn: pitch, yaw, roll against the start.
  void Gaze(const Pose& pose, const glm::dvec3& turn, double t_s) {
    if (m_.look_at) {
      const glm::dvec3 way = *m_.look_at - pose.p_WC;
      target_ = {PitchOf(way), YawOf(way)};
    } else if (around_ == nullptr) {
      target_.y = yaw_0_ + turn.y;
    } else if (t_s >= next_look_s_) {
      Choose(pose, yaw_0_ + turn.y);
      next_look_s_ += std::max(2.0, 0.7 / std::max(carrier_motion_.turn_rate(), 0.05));
    }
    const double wide = std::clamp(1.2 * carrier_motion_.turn_rate(), 0.35, 0.9);  // [rad]
    const double pitch = Beyond(pitch_0_ + turn.x - target_.x, 0.5 * wide),
                 yaw = Beyond(Wrapped(yaw_0_ + turn.y - target_.y), wide);
    const double most = 0.7 * carrier_motion_.turn_rate();
    gaze_.Step(3.3, {std::clamp(-pitch, -most, most), std::clamp(-yaw, -most, most), 0});
  }

  void Choose(const Pose& pose, double yaw) {
    const auto time = static_cast<std::uint32_t>(std::lround(next_look_s_));
    double best = -1;
    for (std::uint32_t i = 0; i < 27; ++i) {
      const double to = yaw + 22.5 * kDegree * (static_cast<int>(i % 9) - 4),
                   up = kDegree * (12.0 * static_cast<int>(i / 9) - 20);  // -20, -8, 4
      const glm::dquat look = Turned(start_.q_WC, {up - pitch_0_, to - yaw_0_, 0});
      const double luck = Uniform(RandomWords(seed_, Stream::carrier_gaze, time, i, 0)[0]);
      const double score = around_->Interest({pose.p_WC, look}) * (0.5 + luck);
      if (score > best) best = score, target_ = {up, to};
    }
  }

  const RoamingMotion& m_;
  const CarrierMotion& carrier_motion_;
  const Pose start_;
  const Surroundings* around_;
  const std::uint64_t seed_;
  const double margin_;
  double yaw_0_, pitch_0_, next_look_s_ = 0;
  glm::dvec2 target_{0.0};                           // pitch and yaw in W
  LowPass<glm::dvec3> moves_, turns_, away_, gaze_;  // the last two so that the acceleration stays bounded
};

// Path of a car: level, along its own axis, with a speed and a curvature of low-passed noise, slower and turning away
// where the way ahead is short. Not fitted to anything.
std::vector<KeyPose> Drive(const RoamingMotion& m, const Pose& start, std::uint64_t seed, double end_s,
                           const Surroundings* around) {
  const double most = m.carrier.speed.value_or(3), yaw_0 = YawOf(start.q_WC * glm::dvec3(0, 0, 1));
  const double far = m.clearance + 2 * most + m.turning_radius;
  const auto ahead = [](double yaw) { return glm::dvec3(-std::sin(yaw), 0, -std::cos(yaw)); };
  LowPass<glm::dvec3> noise, state;
  glm::dvec3 p = start.p_WC;
  double yaw = yaw_0;
  std::vector<KeyPose> keys;
  for (std::size_t k = 0; k < KeysUntil(end_s); ++k) {
    keys.push_back({kStep * static_cast<double>(k), {p, Turned(start.q_WC, {0, yaw - yaw_0, 0})}});
    noise.Draw(0.12, NormalVectors(seed, Stream::carrier_course, static_cast<std::uint32_t>(k), 1)[0]);
    double speed = most * std::clamp(1 + 0.25 * noise.rate.x, 0.0, 2.0);
    double curvature = std::clamp(0.3 * noise.rate.y, -1.0, 1.0) / m.turning_radius;
    if (around != nullptr) {
      double free[3];  // to the left, ahead, to the right
      for (int i = 0; i < 3; ++i) {
        const auto hit = around->Between(p, p + far * ahead(yaw + (1 - i) * 30 * kDegree));
        free[i] = hit ? glm::distance(p, hit->point) : far;
      }
      const double closeness = std::clamp(1.5 - 1.5 * *std::min_element(free, free + 3) / far, 0.0, 1.0);
      curvature += closeness * ((free[0] > free[2] ? 1.0 : -1.0) / m.turning_radius - curvature);
      speed = std::min(speed, std::max(0.0, free[1] - m.clearance));  // within a second
    }
    state.Step(17, {speed, curvature, 0});
    yaw += kStep * state.rate.x * state.rate.y;
    p += kStep * state.rate.x * ahead(yaw);
  }
  return keys;
}

std::uint64_t Attempt(std::uint64_t seed, std::uint32_t attempt) {
  return SeedOf(RandomWords(seed, Stream::carrier_attempt, attempt, 0, 0));
}

}  // namespace

std::unique_ptr<Trajectory> MakeRoaming(const RoamingMotion& m, std::uint64_t scenario_seed, double end_s,
                                        const Surroundings* around) {
  constexpr std::uint32_t kAttempts = 32;
  const std::uint64_t seed = m.carrier.seed.value_or(scenario_seed);
  const CarrierMotion carrier(m.carrier, 0);
  const Pose start = m.start             ? *m.start
                     : around != nullptr ? FreePlaceOf({Level()}, m.clearance + 0.5 * MarginOf(carrier), *around, seed)
                                         : Pose{};
  if (m.carrier.model == Carrier::vehicle)
    return std::make_unique<SplineTrajectory>(Drive(m, start, seed, end_s, around));
  Roamer::Path best;
  best.spare = -1e9;
  for (std::uint32_t attempt = 0; attempt < kAttempts && best.spare < 0; ++attempt) {
    Roamer::Path path = Roamer(m, carrier, start, around, Attempt(seed, attempt)).Draw(KeysUntil(end_s));
    if (path.spare > best.spare) best = std::move(path);
  }
  if (best.spare >= 0) return std::make_unique<SplineTrajectory>(best.keys);
  using settings::FormatNumber;
  throw std::invalid_argument("trajectory: none of " + std::to_string(kAttempts) + " paths keeps the clearance of " +
                              FormatNumber(m.clearance) + " m; the best is at " + FormatPlace(best.place) + " after " +
                              FormatNumber(best.spare_s) + " s, " + FormatNumber(-best.spare) +
                              " m too near to a surface: state a smaller clearance or speed, or another start");
}

std::unique_ptr<Trajectory> Shaken(const Trajectory& path, CarrierMotionParams shake, std::uint64_t seed,
                                   double end_s) {
  constexpr double kFrom_hz = 0.69;
  constexpr int kSamples = 4096;
  if (!shake.speed) shake.speed = MeanSpeed(path, end_s);
  if (!shake.turn_rate) {
    shake.turn_rate = 0;
    for (int i = 0; i < kSamples; ++i) {
      *shake.turn_rate += glm::length(path.At(end_s * (i + 0.5) / kSamples).w_WC_C) / kSamples;
    }
  }
  const std::vector<Offset> offsets = CarrierMotion(shake, kFrom_hz).Draw(shake.seed.value_or(seed), KeysUntil(end_s));
  std::vector<KeyPose> keys;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const double t_s = kStep * static_cast<double>(k);
    const Pose pose = path.At(t_s).pose;
    const glm::dvec3& turn = offsets[k].turn;
    keys.push_back({t_s,
                    {pose.p_WC + offsets[k].move,
                     glm::normalize(pose.q_WC * Exp({0, turn.y, 0}) * Exp({turn.x, 0, 0}) * Exp({0, 0, turn.z}))}});
  }
  return std::make_unique<SplineTrajectory>(keys);
}

}  // namespace sim
