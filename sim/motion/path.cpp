#include "sim/motion/path.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sim/motion/so3.h"

namespace sim {
namespace {

// A number and its first two derivatives by time.
struct Jet {
  double value = 0, rate = 0, bend = 0;
};

Jet At(const Swing& swing, double t) {
  const double w = 2 * std::numbers::pi / swing.period_s, a = swing.size, s = std::sin(w * t), c = std::cos(w * t);
  switch (swing.kind) {
    case Swing::Kind::steady:
      return {a * t / swing.period_s, a / swing.period_s, 0};
    case Swing::Kind::about:
      return {a * s, a * w * c, -a * w * w * s};
    case Swing::Kind::there_and_back:
      return {a * (1 - c) / 2, a * w * s / 2, a * w * w * c / 2};
  }
  return {};
}

// A rotation with its angular rate and acceleration, in the turned frame.
struct Turn {
  glm::dquat q{1, 0, 0, 0};
  glm::dvec3 w{0.0}, alpha{0.0};
};

Turn About(const glm::dvec3& axis, const Jet& angle) {
  return {Exp(angle.value * axis), angle.rate * axis, angle.bend * axis};
}

// First b, then a, as matrices multiply. The rate of a, seen from b's frame, turns against b.
Turn operator*(const Turn& a, const Turn& b) {
  const glm::dvec3 w_a = glm::conjugate(b.q) * a.w, alpha_a = glm::conjugate(b.q) * a.alpha;
  return {a.q * b.q, w_a + b.w, alpha_a + glm::cross(w_a, b.w) + b.alpha};
}

}  // namespace

PathTrajectory::PathTrajectory(const PathMotion& motion)
    : motion_(motion), arm_(motion.start.p_WC - motion.pivot), level_(glm::cross(arm_, glm::dvec3(0, 1, 0))) {
  for (const Swing* swing :
       {&motion.azimuth, &motion.elevation, &motion.yaw, &motion.pitch, &motion.roll, &motion.along}) {
    if (!(swing->period_s > 0) || !std::isfinite(swing->period_s) || !std::isfinite(swing->size)) {
      throw std::invalid_argument("path: a period of " + std::to_string(swing->period_s) + " s, or a size of " +
                                  std::to_string(swing->size));
    }
  }
  if (motion.elevation.size != 0 && !(glm::length(level_) > 1e-9 * glm::length(arm_))) {
    throw std::invalid_argument("path: the pivot is straight above or below the camera, which cannot climb there");
  }
  level_ = glm::length(level_) > 0 ? glm::normalize(level_) : glm::dvec3(1, 0, 0);
}

Motion PathTrajectory::At(double t_s) const {
  const PathMotion& m = motion_;
  const Jet along = sim::At(m.along, t_s);
  const Turn A = About({0, 1, 0}, sim::At(m.azimuth, t_s)) * About(level_, sim::At(m.elevation, t_s));
  const Turn B = About({0, 1, 0}, sim::At(m.yaw, t_s)) * About({1, 0, 0}, sim::At(m.pitch, t_s)) *
                 About({0, 0, 1}, sim::At(m.roll, t_s));
  const Turn C = A * Turn{glm::normalize(m.start.q_WC)} * B;
  Motion motion;
  motion.pose.p_WC = m.pivot + A.q * arm_ + along.value * m.move;
  motion.pose.q_WC = glm::normalize(C.q);
  motion.v_WC = A.q * glm::cross(A.w, arm_) + along.rate * m.move;
  motion.w_WC_C = C.w;
  motion.a_WC = A.q * (glm::cross(A.alpha, arm_) + glm::cross(A.w, glm::cross(A.w, arm_))) + along.bend * m.move;
  motion.alpha_WC_C = C.alpha;
  return motion;
}

double MeanSpeed(const Trajectory& trajectory, double end_s) {
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += glm::length(trajectory.At(end_s * (i + 0.5) / kSteps).v_WC);
  return sum / kSteps;
}

}  // namespace sim
