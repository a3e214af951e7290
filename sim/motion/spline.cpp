#include "sim/motion/spline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <stdexcept>

namespace sim {

SplineTrajectory::SplineTrajectory(const std::vector<KeyPose>& keys) {
  if (keys.size() < 2) throw std::invalid_argument("a spline needs at least two key poses");
  std::string problems;
  glm::dquat last = keys[0].pose.q_WC;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const KeyPose& key = keys[k];
    glm::dquat q = glm::normalize(key.pose.q_WC);
    if (glm::dot(last, q) < 0) q = -q;
    std::ostringstream text;
    if (!std::isfinite(q.w) || !std::isfinite(key.t_s) || !std::isfinite(glm::length(key.pose.p_WC))) {
      text << "the key pose at " << key.t_s << " s is not finite or has no orientation; ";
    } else if (k > 0 && !(key.t_s > keys[k - 1].t_s)) {
      text << "the key pose at " << key.t_s << " s comes after one at " << keys[k - 1].t_s << " s; ";
    } else if (k > 0 && glm::dot(last, q) < 0.5) {
      text << "the camera turns by more than 120 deg between " << keys[k - 1].t_s << " s and " << key.t_s
           << " s: add a key pose between them; ";
    }
    problems += text.str();
    last = q;
    times_.push_back(key.t_s);
    const glm::dvec3& p = key.pose.p_WC;
    values_.push_back({p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  }
  if (!problems.empty()) throw std::invalid_argument(problems.substr(0, problems.size() - 2));

  // Second derivatives m_k: h_k-1 m_k-1 + 2 (h_k-1 + h_k) m_k + h_k m_k+1 = 6 (slope_k - slope_k-1), m = 0 at both
  // ends; elimination and substitution along the keys.
  const std::size_t n = times_.size();
  second_derivatives_.assign(n, Numbers{});
  std::vector<double> upper(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = times_[k] - times_[k - 1], after = times_[k + 1] - times_[k];
    const double pivot = 2 * (before + after) - before * upper[k - 1];
    upper[k] = after / pivot;
    for (std::size_t i = 0; i < 7; ++i) {
      const double bend = (values_[k + 1][i] - values_[k][i]) / after - (values_[k][i] - values_[k - 1][i]) / before;
      second_derivatives_[k][i] = (6 * bend - before * second_derivatives_[k - 1][i]) / pivot;
    }
  }
  for (std::size_t k = n - 1; k-- > 1;) {
    for (std::size_t i = 0; i < 7; ++i) second_derivatives_[k][i] -= upper[k] * second_derivatives_[k + 1][i];
  }
}

Motion SplineTrajectory::At(double t_s) const {
  // Beyond the ends the numbers go on along straight lines, which is C2 too.
  const double t = std::clamp(t_s, times_.front(), times_.back());
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  const std::size_t k = static_cast<std::size_t>(next - times_.begin()) - 1;
  const double h = times_[k + 1] - times_[k];
  const double b = (t - times_[k]) / h, a = 1 - b;
  Numbers value, slope, bend;
  for (std::size_t i = 0; i < 7; ++i) {
    const double y0 = values_[k][i], y1 = values_[k + 1][i];
    const double m0 = second_derivatives_[k][i], m1 = second_derivatives_[k + 1][i];
    slope[i] = (y1 - y0) / h + h / 6 * ((3 * b * b - 1) * m1 - (3 * a * a - 1) * m0);
    bend[i] = t == t_s ? a * m0 + b * m1 : 0.0;
    value[i] = a * y0 + b * y1 + h * h / 6 * ((a * a * a - a) * m0 + (b * b * b - b) * m1) + slope[i] * (t_s - t);
  }
  const glm::dquat s(value[6], value[3], value[4], value[5]), ds(slope[6], slope[3], slope[4], slope[5]),
      dds(bend[6], bend[3], bend[4], bend[5]);
  const glm::dquat rate = glm::conjugate(s) * ds, rate2 = glm::conjugate(s) * dds;
  Motion motion;
  motion.pose.p_WC = {value[0], value[1], value[2]};
  motion.pose.q_WC = glm::normalize(s);
  motion.v_WC = {slope[0], slope[1], slope[2]};
  motion.w_WC_C = 2.0 / glm::dot(s, s) * glm::dvec3(rate.x, rate.y, rate.z);
  motion.a_WC = {bend[0], bend[1], bend[2]};
  // conj(ds/dt) ds/dt has no vector part; d|s|^2/dt = 2 rate.w.
  motion.alpha_WC_C = 2.0 / glm::dot(s, s) * (glm::dvec3(rate2.x, rate2.y, rate2.z) - rate.w * motion.w_WC_C);
  return motion;
}

}  // namespace sim
