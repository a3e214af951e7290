#include <algorithm>
#include <cmath>

#include "tools/base/text.h"
#include "tools/judge/verification/comparisons.h"
#include "vo/geometry/so3.h"

namespace verification {
namespace {

using Eigen::Vector3d;

constexpr double kSigmas = 6;        // bound on random errors: exceeded by one line in 5 10^8
constexpr double kText = 1e-11;      // rounding of the texts' twelve decimals, and of the sums here
constexpr std::ptrdiff_t kNear = 5;  // neighbours from which the curvature of a rate follows
constexpr double kSafety = 2;        // on that curvature; below 3, so that a single wrong line is still detected

struct Rate {
  double t_s;
  Vector3d value;
};

Vector3d Numbers(const Entry& entry, std::size_t first) {
  return {entry.numbers[first], entry.numbers[first + 1], entry.numbers[first + 2]};
}

std::vector<Rate> Rates(const std::vector<Entry>& entries, std::size_t first, std::int64_t origin_ns) {
  std::vector<Rate> rates;
  for (const Entry& entry : entries) {
    rates.push_back({static_cast<double>(entry.stamp_ns - origin_ns) * 1e-9, Numbers(entry, first)});
  }
  return rates;
}

// The largest second derivative of the rates near k .. k + 1, by divided differences.
double SecondDerivative(const std::vector<Rate>& rates, std::size_t k) {
  const auto n = static_cast<std::ptrdiff_t>(rates.size()), at = static_cast<std::ptrdiff_t>(k);
  double largest = 0;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(at - kNear, 1); i <= std::min(at + 1 + kNear, n - 2); ++i) {
    const Rate &a = rates[static_cast<std::size_t>(i - 1)], &b = rates[static_cast<std::size_t>(i)],
               &c = rates[static_cast<std::size_t>(i + 1)];
    const Vector3d slope_ab = (b.value - a.value) / (b.t_s - a.t_s), slope_bc = (c.value - b.value) / (c.t_s - b.t_s);
    largest = std::max(largest, 2 * (slope_bc - slope_ab).norm() / (c.t_s - a.t_s));
  }
  return largest;
}

// Error of the trapezoidal rule from one line to the next: dt^3 / 12 of the rate's second derivative. White
// acceleration of density s adds s sqrt(dt^3 / 12) per axis of a position between two exact values.
struct Step {
  double dt;
  std::string where;
  std::size_t frame;
};
std::vector<Step> Steps(const Sequence& s, const std::vector<Entry>& rates, const char* file) {
  std::vector<Step> steps;
  for (std::size_t k = 0; k + 1 < rates.size(); ++k) {
    const auto at = std::lower_bound(s.stamps.begin(), s.stamps.end(), rates[k].stamp_ns);
    const auto frame = static_cast<std::size_t>(at - s.stamps.begin());
    const bool known = frame + 1 < s.stamps.size() && s.stamps[frame] == rates[k].stamp_ns &&
                       s.stamps[frame + 1] == rates[k + 1].stamp_ns && s.has_pose[frame] && s.has_pose[frame + 1];
    const double dt = static_cast<double>(rates[k + 1].stamp_ns - rates[k].stamp_ns) * 1e-9;
    steps.push_back({known ? dt : 0,
                     std::string(file) + " " + base::FormatSeconds(rates[k].stamp_ns) + " to " +
                         base::FormatSeconds(rates[k + 1].stamp_ns),
                     frame});
  }
  return steps;
}

void CheckVelocities(const Sequence& s, Check& position, Check& orientation) {
  const auto table = s.texts.find("velocity");
  if (table == s.texts.end() || table->second.size() < 3) return;
  const std::vector<Entry>& lines = table->second;
  const std::vector<Rate> v = Rates(lines, 0, lines[0].stamp_ns), w = Rates(lines, 3, lines[0].stamp_ns);
  const std::vector<Step> steps = Steps(s, lines, "velocity.txt");
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double dt = steps[k].dt;
    if (dt <= 0) continue;
    const vo::Pose &a = s.poses[steps[k].frame], &b = s.poses[steps[k].frame + 1];
    const double rule = kSafety * dt * dt * dt / 12, root = std::sqrt(3 * dt * dt * dt / 12);
    const Vector3d moved = b.p_WC - a.p_WC - dt / 2 * (v[k].value + v[k + 1].value);
    position.Add(moved.norm(), rule * SecondDerivative(v, k) + kSigmas * root * s.roughness.position + kText,
                 steps[k].where);
    // Second term of the Magnus series: body rates of changing direction; the next is below |w|^2 dt^2 of the rule.
    const Vector3d turned = vo::Log(a.q_WC.conjugate() * b.q_WC) - dt / 2 * (w[k].value + w[k + 1].value) -
                            dt * dt / 12 * w[k].value.cross(w[k + 1].value);
    const double noise = s.roughness.orientation * (1 + dt * w[k].value.norm());
    orientation.Add(turned.norm(), rule * SecondDerivative(w, k) + kSigmas * root * noise + kText, steps[k].where);
  }
}

// Between two lines of a sampled path its accelerations jump at every knot h: at a knot they have the variance 4 s^2 /
// h about 0, and the change of velocity s^2 dt.
void CheckAccelerations(const Sequence& s, Check& linear, Check& angular) {
  const auto accelerations = s.texts.find("acceleration"), velocities = s.texts.find("velocity");
  if (accelerations == s.texts.end() || velocities == s.texts.end()) return;
  const std::vector<Entry>&a = accelerations->second, &v = velocities->second;
  if (a.size() < 3 || a.size() != v.size()) return;
  const std::vector<Step> steps = Steps(s, a, "acceleration.txt");
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const std::vector<Rate> rates = Rates(a, first, a[0].stamp_ns);
    const double density = first == 0 ? s.roughness.position : s.roughness.orientation;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const double dt = steps[k].dt;
      if (dt <= 0 || a[k].stamp_ns != v[k].stamp_ns || a[k + 1].stamp_ns != v[k + 1].stamp_ns) continue;
      const Vector3d gained =
          Numbers(v[k + 1], first) - Numbers(v[k], first) - dt / 2 * (rates[k].value + rates[k + 1].value);
      const double rough =
          s.roughness.sampled ? density * std::sqrt(3 * dt * (1 + 2 * dt / s.roughness.knot_step_s)) : 0;
      const double bound = kSafety * dt * dt * dt / 12 * SecondDerivative(rates, k) + kSigmas * rough + kText;
      (first == 0 ? linear : angular).Add(gained.norm(), bound, steps[k].where);
    }
  }
}

struct State {
  Vector3d p, v;
  Eigen::Quaterniond q;  // of I, in W
};

// The first reading behind a time.
std::vector<Entry>::const_iterator After(const std::vector<Entry>& readings, std::int64_t t_ns) {
  return std::ranges::upper_bound(readings, t_ns, {}, &Entry::stamp_ns);
}

// w, or f, at a time. Readings are joined by straight lines (instant) or held over their period (mean).
Vector3d Reading(const Imu& imu, std::int64_t t_ns, std::size_t first) {
  const auto next = After(imu.readings, t_ns);
  const Entry &a = *(next - 1), &b = next == imu.readings.end() ? a : *next;
  if (b.stamp_ns == a.stamp_ns) return Numbers(a, first);
  const double part = static_cast<double>(t_ns - a.stamp_ns) / static_cast<double>(b.stamp_ns - a.stamp_ns);
  if (imu.mean) return Numbers(part < 0.5 ? a : b, first);
  return (1 - part) * Numbers(a, first) + part * Numbers(b, first);
}

void Advance(const Imu& imu, std::int64_t from_ns, std::int64_t to_ns, State& x) {
  const double dt = static_cast<double>(to_ns - from_ns) * 1e-9;
  const std::int64_t middle = from_ns + (to_ns - from_ns) / 2;
  const std::int64_t begin = imu.mean ? middle : from_ns, end = imu.mean ? middle : to_ns;
  const Vector3d w0 = Reading(imu, begin, 0), w1 = Reading(imu, end, 0);
  const Vector3d f0 = Reading(imu, begin, 3), f1 = Reading(imu, end, 3);
  const Eigen::Quaterniond q1 = (x.q * vo::Exp(dt / 2 * (w0 + w1) + dt * dt / 12 * w0.cross(w1))).normalized();
  const Eigen::Quaterniond half = (x.q * vo::Exp(dt / 4 * (w0 + w1))).normalized();
  const Vector3d g = imu.gravity_W;
  const Vector3d a0 = x.q * f0 + g, am = half * (0.5 * (f0 + f1)) + g, a1 = q1 * f1 + g;
  x.p += dt * x.v + dt * dt / 6 * (a0 + 2 * am);
  x.v += dt / 6 * (a0 + 4 * am + a1);
  x.q = q1;
}

// Dead reckoning from one frame's pose and velocity to the next frame's stamp. Also the variation of the readings on
// the way: the largest difference of neighbours, and of neighbouring differences.
bool Reckon(const Imu& imu, std::int64_t from_ns, std::int64_t to_ns, State& x, double (&first)[2],
            double (&second)[2]) {
  const std::vector<Entry>& r = imu.readings;
  const auto begin = static_cast<std::size_t>(After(r, from_ns) - r.begin()),
             end = static_cast<std::size_t>(After(r, to_ns) - r.begin());
  if (begin < 2 || end + 1 >= r.size()) return false;
  const auto period = static_cast<std::int64_t>(std::llround(1e9 / imu.rate_hz));
  std::vector<std::int64_t> times{from_ns};
  for (std::size_t i = begin - 1; i <= end; ++i) {
    const std::int64_t t = imu.mean ? r[i].stamp_ns - period / 2 : r[i].stamp_ns;
    if (t > from_ns && t < to_ns) times.push_back(t);
  }
  times.push_back(to_ns);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) Advance(imu, times[i], times[i + 1], x);
  for (std::size_t i = begin - 1; i <= end; ++i) {
    for (const std::size_t c : {std::size_t{0}, std::size_t{1}}) {
      const Vector3d step = Numbers(r[i], 3 * c) - Numbers(r[i - 1], 3 * c);
      first[c] = std::max(first[c], step.norm());
      if (i >= 2) second[c] = std::max(second[c], (step - Numbers(r[i - 1], 3 * c) + Numbers(r[i - 2], 3 * c)).norm());
    }
  }
  return true;
}

void CheckImu(const Sequence& s, Check& velocity, Check& orientation) {
  const auto velocities = s.texts.find("velocity");
  if (!s.has_imu || velocities == s.texts.end()) return;
  const std::vector<Entry>& v = velocities->second;
  const double period = 1 / s.imu.rate_hz;
  const auto state = [&](std::size_t frame, const Entry& line) {
    const vo::Pose& pose = s.poses[frame];
    const Vector3d arm = pose.q_WC * Numbers(line, 3).cross(s.imu.T_CI.p_WC);
    return State{pose.p_WC + pose.q_WC * s.imu.T_CI.p_WC, Numbers(line, 0) + arm, pose.q_WC * s.imu.T_CI.q_WC};
  };
  const std::vector<Step> steps = Steps(s, v, "imu0/data.csv");
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double dt = steps[k].dt;
    if (dt <= 0) continue;
    State x = state(steps[k].frame, v[k]);
    const State end = state(steps[k].frame + 1, v[k + 1]);
    double first[2] = {}, second[2] = {};
    if (!Reckon(s.imu, v[k].stamp_ns, v[k + 1].stamp_ns, x, first, second)) continue;
    // Linear interpolation between readings has an error of at most period^2 / 8 of the second derivative; a mean used
    // for part of its period, at either end, of the difference of neighbours. The path's own roughness between
    // readings.
    const double t = static_cast<double>(v[k + 1].stamp_ns) * 1e-9;
    const auto bound = [&](std::size_t c, double noise, double walk, double density) {
      const double rule = s.imu.mean ? 2 * period * first[c] + dt * second[c] / 8 : kSafety * dt * second[c] / 8;
      const double rough =
          s.roughness.sampled
              ? density * std::sqrt(3 * (s.imu.mean ? 2 * period : dt * (1 + 4 * period / s.roughness.knot_step_s)))
              : 0;
      return rule + kSigmas * (rough + std::sqrt(3.0) * (noise * std::sqrt(dt + period) + walk * std::sqrt(t) * dt)) +
             1e-9;
    };
    const double turn = bound(0, s.imu.gyroscope_noise, s.imu.gyroscope_walk, s.roughness.orientation);
    const double arm = s.imu.T_CI.p_WC.norm();
    const double gain = bound(1, s.imu.accelerometer_noise, s.imu.accelerometer_walk,
                              s.roughness.position + arm * s.roughness.orientation);
    double force = 0;  // largest |f|, which a wrong rotation turns
    for (const Entry& reading : s.imu.readings) {
      if (reading.stamp_ns >= v[k].stamp_ns && reading.stamp_ns <= v[k + 1].stamp_ns)
        force = std::max(force, Numbers(reading, 3).norm());
    }
    orientation.Add(vo::Log(x.q.conjugate() * end.q).norm(), turn, steps[k].where);
    velocity.Add((x.v - end.v).norm(), gain + dt * force * turn, steps[k].where);
  }
}

}  // namespace

std::vector<Check> CheckMotion(const Sequence& sequence) {
  std::vector<Check> checks = {
      {"velocity against poses: position", "m"}, {"velocity against poses: orientation", "rad"},
      {"acceleration against velocity", "m/s"},  {"angular acceleration against rate", "rad/s"},
      {"IMU against poses: velocity", "m/s"},    {"IMU against poses: orientation", "rad"}};
  CheckVelocities(sequence, checks[0], checks[1]);
  CheckAccelerations(sequence, checks[2], checks[3]);
  CheckImu(sequence, checks[4], checks[5]);
  return checks;
}

}  // namespace verification
