#include "tools/judge/evaluation/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

constexpr double kNormTolerance = 1e-3;
constexpr double kSamePosition = 0.01;                  // [m]
constexpr double kSameOrientation = 0.017453292519943;  // 1 degree

// The stamp and N numbers of a line; nothing, with the problems noted, when any is bad.
template <std::size_t N>
std::optional<std::pair<std::int64_t, std::array<double, N>>> ParseLine(const std::filesystem::path& file,
                                                                        const Line& line, const char* columns,
                                                                        Problems& problems) {
  if (line.tokens.size() != N + 1) {
    problems.Add(file, line.number, line.tokens.front().column,
                 std::to_string(line.tokens.size()) + " columns where " + std::to_string(N + 1) + " are expected (" +
                     columns + ")");
    return std::nullopt;
  }
  bool good = true;
  const auto stamp = base::ParseSeconds(line.tokens[0].text);
  if (!stamp) {
    problems.Add(file, line.number, line.tokens[0].column,
                 "'" + line.tokens[0].text + "' is not a time in seconds, 4e9 at most");
    good = false;
  }
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const Token& token = line.tokens[i + 1];
    if (const auto number = ParseNumber(token.text)) {
      numbers[i] = *number;
    } else {
      problems.Add(file, line.number, token.column, "'" + token.text + "' is not a finite number");
      good = false;
    }
  }
  if (!good) return std::nullopt;
  return std::pair{*stamp, numbers};
}

void RequireWritable(const std::filesystem::path& file, std::size_t index, bool finite, bool increasing) {
  if (finite && increasing) return;
  throw std::invalid_argument(file.string() + ": entry " + std::to_string(index) +
                              (finite ? " is not later than the one before" : " holds a number that is not finite") +
                              "; nothing was written");
}

}  // namespace

Trajectory ReadTrajectory(const std::filesystem::path& file, Reading reading) {
  Problems problems;
  Trajectory trajectory;
  for (const Line& line : ReadLines(file)) {
    const auto parsed = ParseLine<7>(file, line, "timestamp tx ty tz qx qy qz qw", problems);
    if (!parsed) continue;
    const auto& [stamp, n] = *parsed;
    StampedPose pose{stamp, {n[0], n[1], n[2]}, Eigen::Quaterniond(n[6], n[3], n[4], n[5])};
    const double norm = pose.q_WC.norm();
    if (std::abs(norm - 1) > kNormTolerance) {
      problems.Add(file, line.number, line.tokens[4].column,
                   "the quaternion's norm is " + base::Significant(norm, 6) + ", which differs from 1 by more than " +
                       base::Significant(kNormTolerance, 1));
      continue;
    }
    if (reading == Reading::strict) pose.q_WC.normalize();
    if (!trajectory.empty() && stamp < trajectory.back().stamp_ns) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " lies before " + base::FormatSeconds(trajectory.back().stamp_ns) +
                       ", the time of the pose above");
      continue;
    }
    if (!trajectory.empty() && stamp == trajectory.back().stamp_ns) {
      const StampedPose& first = trajectory.back();
      if ((pose.p_WC - first.p_WC).norm() > kSamePosition || AngleBetween(first.q_WC, pose.q_WC) > kSameOrientation) {
        problems.Add(file, line.number, line.tokens[0].column,
                     "time " + line.tokens[0].text + " has a second pose that differs from the first");
      }
      if (reading == Reading::strict) continue;
    }
    trajectory.push_back(pose);
  }
  problems.ThrowIfAny();
  if (trajectory.empty()) throw InputError({file.string() + ": holds no pose"});
  return trajectory;
}

void WriteTrajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  base::AtomicFile out(file);
  out.Append("# timestamp tx ty tz qx qy qz qw\n");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const StampedPose& pose = trajectory[i];
    RequireWritable(file, i, pose.p_WC.allFinite() && pose.q_WC.coeffs().allFinite(),
                    i == 0 || pose.stamp_ns > trajectory[i - 1].stamp_ns);
    const Eigen::Vector4d q = pose.q_WC.w() < 0 ? Eigen::Vector4d(-pose.q_WC.coeffs()) : pose.q_WC.coeffs();
    std::string text = base::FormatSeconds(pose.stamp_ns);
    for (const double value : {pose.p_WC.x(), pose.p_WC.y(), pose.p_WC.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ' + base::Significant(value, 12);
    }
    out.Append(text + '\n');
  }
  out.Commit();
}

Velocities ReadVelocities(const std::filesystem::path& file) {
  Problems problems;
  Velocities velocities;
  for (const Line& line : ReadLines(file)) {
    const auto parsed = ParseLine<6>(file, line, "timestamp vx vy vz wx wy wz", problems);
    if (!parsed) continue;
    const auto& [stamp, n] = *parsed;
    if (!velocities.empty() && stamp <= velocities.back().stamp_ns) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " is not later than " +
                       base::FormatSeconds(velocities.back().stamp_ns) + ", the time above");
      continue;
    }
    velocities.push_back({stamp, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  problems.ThrowIfAny();
  if (velocities.empty()) throw InputError({file.string() + ": holds no velocity"});
  return velocities;
}

void WriteVelocities(const std::filesystem::path& file, const Velocities& velocities) {
  base::AtomicFile out(file);
  out.Append("# timestamp vx vy vz wx wy wz\n");
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const StampedVelocity& entry = velocities[i];
    RequireWritable(file, i, entry.v_WC.allFinite() && entry.w_WC_C.allFinite(),
                    i == 0 || entry.stamp_ns > velocities[i - 1].stamp_ns);
    std::string text = base::FormatSeconds(entry.stamp_ns);
    for (int k = 0; k < 3; ++k) text += ' ' + base::Significant(entry.v_WC[k], 12);
    for (int k = 0; k < 3; ++k) text += ' ' + base::Significant(entry.w_WC_C[k], 12);
    out.Append(text + '\n');
  }
  out.Commit();
}

std::optional<StampedVelocity> VelocityAt(const Velocities& velocities, std::int64_t stamp_ns) {
  const auto found = std::lower_bound(velocities.begin(), velocities.end(), stamp_ns,
                                      [](const StampedVelocity& v, std::int64_t t) { return v.stamp_ns < t; });
  if (found == velocities.end() || found->stamp_ns != stamp_ns) return std::nullopt;
  return *found;
}

std::vector<double> CumulativePathLength(const Trajectory& trajectory) {
  std::vector<double> way;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    way.push_back(i == 0 ? 0 : way.back() + (trajectory[i].p_WC - trajectory[i - 1].p_WC).norm());
  }
  return way;
}

double PathLength(const Trajectory& trajectory) {
  return trajectory.empty() ? 0 : CumulativePathLength(trajectory).back();
}

}  // namespace evaluation
