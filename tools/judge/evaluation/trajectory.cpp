#include "tools/judge/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tools/base/files.h"
#include "tools/base/pose_table.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

constexpr double kNormTolerance = 1e-3;
constexpr double kSamePosition = 0.01;                  // [m]
constexpr double kSameOrientation = 0.017453292519943;  // 1 degree

// A row whose position and quaternion are nan, as data sets write where they have no truth.
bool IsWithoutPose(const Line& line) {
  return line.tokens.size() == 8 &&
         std::ranges::all_of(line.tokens.begin() + 1, line.tokens.end(), [](const Token& token) {
           const std::optional<double> number = base::ParseNumber(token.text);
           return number && std::isnan(*number);
         });
}

// Whether all stamps are whole seconds, 10 s and more apart.
bool AreFarApart(const Trajectory& trajectory) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const auto is_near = [](const StampedPose& a, const StampedPose& b) {
    return b.stamp_ns - a.stamp_ns < 10 * kSecond_ns || a.stamp_ns % kSecond_ns != 0 || b.stamp_ns % kSecond_ns != 0;
  };
  return trajectory.size() > 2 && std::ranges::adjacent_find(trajectory, is_near) == trajectory.end();
}

// A line per entry: its stamp and its numbers.
template <class Entries, class NumbersOf>
void Write(const std::filesystem::path& file, const char* header, const Entries& entries, const NumbersOf& numbers_of) {
  base::AtomicFile out(file);
  out.Append(header);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto numbers = numbers_of(entries[i]);
    const bool finite = std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
    if (!finite || (i > 0 && entries[i].stamp_ns <= entries[i - 1].stamp_ns)) {
      throw std::invalid_argument(
          file.string() + ": entry " + std::to_string(i) +
          (finite ? " is not later than the one before" : " holds a number that is not finite") +
          "; nothing was written");
    }
    out.Append(base::FormatSeconds(entries[i].stamp_ns) + FormatNumbers(numbers) + '\n');
  }
  out.Commit();
}

}  // namespace

Trajectory ReadTrajectory(const std::filesystem::path& file, Reading reading) {
  Problems problems;
  Trajectory trajectory;
  base::PoseTable table(reading == Reading::euroc);
  int unordered = 0, without_pose = 0;
  for (const Line& text : Lines(file, '\n')) {
    Line line{text.number, {}};
    std::string other_kind;
    for (const base::Word& word : table.Row(text.tokens[0].text, other_kind))
      line.tokens.push_back(
          {line.tokens.empty() ? table.Stamp(word) : std::string(word.text), word.column + text.tokens[0].column - 1});
    if (!other_kind.empty())
      throw InputError({file.string() + ":" + std::to_string(line.number) + ":1: " + other_kind});
    if (line.tokens.empty()) continue;
    if (IsWithoutPose(line)) {
      if (++without_pose == 1)
        problems.Add(file, line.number, line.tokens[1].column, "the pose is nan: leave out such rows (`grep -vi nan`)");
      continue;
    }
    std::array<double, 7> n{};
    const auto parsed = ParseRow(file, line, "timestamp tx ty tz qx qy qz qw", n, problems);
    if (!parsed) continue;
    const std::int64_t stamp = *parsed;
    StampedPose pose{stamp, {n[0], n[1], n[2]}, Eigen::Quaterniond(n[6], n[3], n[4], n[5])};
    const double norm = pose.q_WC.norm();
    if (std::abs(norm - 1) > kNormTolerance) {
      problems.Add(file, line.number, line.tokens[4].column,
                   "the quaternion's norm is " + base::Significant(norm, 6) + ", which differs from 1 by more than " +
                       base::Significant(kNormTolerance, 1));
      continue;
    }
    if (reading != Reading::as_written) pose.q_WC.normalize();
    if (!trajectory.empty() && stamp < trajectory.back().stamp_ns) {
      if (++unordered > 1) continue;  // one cause
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " lies before " + base::FormatSeconds(trajectory.back().stamp_ns) +
                       ", the time of the pose above: sort the lines (`sort -g`)");
      continue;
    }
    if (!trajectory.empty() && stamp == trajectory.back().stamp_ns) {
      const StampedPose& kept = trajectory.back();
      if ((pose.p_WC - kept.p_WC).norm() > kSamePosition || AngleBetween(kept.q_WC, pose.q_WC) > kSameOrientation) {
        problems.Add(file, line.number, line.tokens[0].column,
                     "time " + line.tokens[0].text + " has a second pose that differs from the first");
      }
      if (reading != Reading::as_written) continue;
    }
    trajectory.push_back(pose);
  }
  problems.ThrowIfAny();
  if (trajectory.empty()) throw InputError({file.string() + ": holds no pose"});
  if (reading != Reading::as_written && AreFarApart(trajectory))
    throw InputError({file.string() +
                      ": all poses are 10 s and more apart: stamps are seconds; name another unit in a header "
                      "(# timestamp_ms tx ty tz qx qy qz qw)"});
  return trajectory;
}

void WriteTrajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  Write(file, "# timestamp tx ty tz qx qy qz qw\n", trajectory, [](const StampedPose& pose) {
    const Eigen::Vector3d& p = pose.p_WC;
    const Eigen::Vector4d q = pose.q_WC.w() < 0 ? Eigen::Vector4d(-pose.q_WC.coeffs()) : pose.q_WC.coeffs();
    return std::array{p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  });
}

Velocities ReadVelocities(const std::filesystem::path& file) {
  Problems problems;
  Velocities velocities;
  for (const Line& line : Lines(file)) {
    std::array<double, 6> n{};
    const auto stamp = ParseRow(file, line, "timestamp vx vy vz wx wy wz", n, problems);
    if (!stamp) continue;
    if (!velocities.empty() && *stamp <= velocities.back().stamp_ns) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " is not later than " +
                       base::FormatSeconds(velocities.back().stamp_ns) + ", the time above");
      continue;
    }
    velocities.push_back({*stamp, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  problems.ThrowIfAny();
  if (velocities.empty()) throw InputError({file.string() + ": holds no velocity"});
  return velocities;
}

std::array<double, 6> NumbersOf(const StampedVelocity& entry) {
  const Eigen::Vector3d &v = entry.v_WC, &w = entry.w_WC_C;
  return {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
}

void WriteVelocities(const std::filesystem::path& file, const Velocities& velocities) {
  Write(file, "# timestamp vx vy vz wx wy wz\n", velocities, NumbersOf);
}

std::optional<StampedVelocity> VelocityAt(const Velocities& velocities, std::int64_t stamp_ns) {
  const auto found = std::ranges::lower_bound(velocities, stamp_ns, {}, &StampedVelocity::stamp_ns);
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

double Spread(const Trajectory& trajectory) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory) mean += pose.p_WC / static_cast<double>(trajectory.size());
  double squares = 0;
  for (const StampedPose& pose : trajectory) squares += (pose.p_WC - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(trajectory.size(), 1)));
}

}  // namespace evaluation
