#include "sim/motion/sampled.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "sim/motion/so3.h"
#include "sim/random/random.h"

namespace sim {
namespace {

// (n1, n2). Cholesky: Q = L L^T with L = sigma [h^1.5/sqrt(3) 0; sqrt(3 h)/2 sqrt(h)/2].
std::array<glm::dvec3, 2> Draw(std::uint64_t seed, Stream stream, std::size_t knot, double sigma, double h) {
  const auto [a, b] = NormalVectors(seed, stream, static_cast<std::uint32_t>(knot), 0);
  return {sigma * std::sqrt(h * h * h / 3) * a, sigma * (std::sqrt(3 * h) / 2 * a + std::sqrt(h) / 2 * b)};
}

glm::dvec3 Drawn(const glm::dvec3& mean, double sigma, std::uint64_t seed, std::uint32_t which) {
  return sigma > 0 ? mean + sigma * NormalVectors(seed, Stream::start_velocity, 0, which)[0] : mean;
}

// Acceleration by the walls: within the margin, critically damped towards its inner edge while the camera is beyond it
// or moves outwards.
glm::dvec3 Push(const SoftWalls& walls, const glm::dvec3& p, const glm::dvec3& v) {
  glm::dvec3 a(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double over = std::max(p[axis] - (walls.high[axis] - walls.margin), 0.0) +
                        std::min(p[axis] - (walls.low[axis] + walls.margin), 0.0);
    if (over == 0) continue;
    a[axis] = -walls.rate * walls.rate * over - (over * v[axis] > 0 ? 2 * walls.rate * v[axis] : 0.0);
  }
  return a;
}

void Check(const SampledMotion& m, double end_s) {
  std::vector<settings::FieldProblem> problems = Problems(m);
  const double length = glm::length(m.start.q_WC) + glm::length(m.start.p_WC);
  if (!(glm::length(m.start.q_WC) > 0) || !std::isfinite(length)) problems.push_back({"start", "is no pose"});
  if (!(end_s >= 0 && end_s / m.knot_step_s < (1 << 25)))
    problems.push_back({"duration", "must be at least 0 and less than 2^25 knots"});
  ThrowIfAny(problems, "sampled motion");
}

Motion GoOn(const Motion& from, double dt) {
  Motion to{from.pose, from.v_WC, from.w_WC_C};  // without acceleration
  to.pose.p_WC += dt * from.v_WC;
  to.pose.q_WC = glm::normalize(from.pose.q_WC * Exp(dt * from.w_WC_C));
  return to;
}

}  // namespace

std::vector<settings::FieldProblem> Problems(SampledMotion m) {
  settings::FieldCheck check;
  Visit(check, m);
  const auto slow = [&](const char* key, double rate) {
    check.Require(rate * m.knot_step_s <= 0.2, key, rate, "must not be above 0.2 / knot_step");
  };
  slow("position_return", m.position_return);
  slow("orientation_return", m.orientation_return);
  if (!m.walls) return check.problems;
  const SoftWalls& w = *m.walls;
  slow("walls.rate", w.rate);
  for (int axis = 0; axis < 3; ++axis) {
    check.Require(w.high[axis] - w.low[axis] >= 2 * w.margin, "walls.high", w.high[axis],
                  "must lie at least two margins above low");
    check.Require(m.start.p_WC[axis] >= w.low[axis] && m.start.p_WC[axis] <= w.high[axis], "start.position",
                  m.start.p_WC[axis], "must lie within the walls");
  }
  return check.problems;
}

SampledTrajectory::SampledTrajectory(const SampledMotion& m, std::uint64_t seed, double end_s)
    : step_s_(m.knot_step_s) {
  Check(m, end_s);
  const double h = step_s_;
  Motion x{m.start, Drawn(m.velocity, m.velocity_sigma, seed, 0), Drawn(m.angular_rate, m.angular_rate_sigma, seed, 1)};
  x.pose.q_WC = glm::normalize(x.pose.q_WC);
  const Pose start = x.pose;
  const std::size_t steps = static_cast<std::size_t>(std::ceil(end_s / h - 1e-9)) + 1;
  knots_.reserve(steps + 1);
  knots_.push_back(x);
  for (std::size_t k = 0; k < steps; ++k) {
    const auto [moved, moved_faster] = Draw(seed, Stream::position_noise, k, m.position_noise, h);
    const auto [turned, turned_faster] = Draw(seed, Stream::orientation_noise, k, m.orientation_noise, h);
    const double r = m.position_return, s = m.orientation_return;
    glm::dvec3 a = -r * r * (x.pose.p_WC - start.p_WC) - 2 * r * x.v_WC;
    if (m.walls) a += Push(*m.walls, x.pose.p_WC, x.v_WC);
    const glm::dvec3 b = -s * s * Log(glm::conjugate(start.q_WC) * x.pose.q_WC) - 2 * s * x.w_WC_C;
    x.pose.p_WC += h * x.v_WC + h * h / 2 * a + moved;
    x.v_WC += h * a + moved_faster;
    x.pose.q_WC = glm::normalize(x.pose.q_WC * Exp(h * x.w_WC_C + h * h / 2 * b + turned));
    x.w_WC_C += h * b + turned_faster;
    knots_.push_back(x);
  }
}

Motion SampledTrajectory::At(double t_s) const {
  if (t_s < 0) return GoOn(knots_.front(), t_s);
  const double last = step_s_ * static_cast<double>(knots_.size() - 1);
  if (t_s >= last) return GoOn(knots_.back(), t_s - last);
  const std::size_t k = std::min(static_cast<std::size_t>(t_s / step_s_), knots_.size() - 2);
  const Motion &from = knots_[k], &to = knots_[k + 1];
  const double h = step_s_, u = t_s / h - static_cast<double>(k);

  // Hermite's cubics and their derivatives by u: of the value at 1, of the slopes at 0 and 1 (per h); the value at 0
  // has 1 - h01.
  const double h01 = u * u * (3 - 2 * u), h10 = u * (1 - u) * (1 - u), h11 = u * u * (u - 1);
  const double d01 = 6 * u * (1 - u), d10 = (1 - u) * (1 - 3 * u), d11 = u * (3 * u - 2);
  const double e01 = 6 - 12 * u, e10 = 6 * u - 4, e11 = 6 * u - 2;  // second derivatives

  Motion motion;
  const glm::dvec3 moved = to.pose.p_WC - from.pose.p_WC;
  motion.pose.p_WC = from.pose.p_WC + h01 * moved + h * (h10 * from.v_WC + h11 * to.v_WC);
  motion.v_WC = d01 / h * moved + d10 * from.v_WC + d11 * to.v_WC;
  motion.a_WC = e01 / (h * h) * moved + (e10 * from.v_WC + e11 * to.v_WC) / h;

  // The same for the rotation vector from the earlier knot, whose slope at the later one is J_r^-1 w.
  const glm::dvec3 turned = Log(glm::conjugate(from.pose.q_WC) * to.pose.q_WC);
  const glm::dvec3 slope = InverseRightJacobianTimes(turned, to.w_WC_C);
  const glm::dvec3 phi = h01 * turned + h * (h10 * from.w_WC_C + h11 * slope);
  const glm::dvec3 rate = d01 / h * turned + d10 * from.w_WC_C + d11 * slope;
  motion.pose.q_WC = glm::normalize(from.pose.q_WC * Exp(phi));
  motion.w_WC_C = RightJacobianTimes(phi, rate);
  const glm::dvec3 bend = e01 / (h * h) * turned + (e10 * from.w_WC_C + e11 * slope) / h;
  motion.alpha_WC_C = RightJacobianTimes(phi, bend) + RightJacobianRateTimes(phi, rate, rate);
  return motion;
}

}  // namespace sim
