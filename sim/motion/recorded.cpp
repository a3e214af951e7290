#include "sim/motion/recorded.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/motion/placement.h"
#include "sim/motion/spline.h"
#include "tools/base/pose_table.h"
#include "tools/base/settings/problem.h"
#include "tools/base/settings/quantity.h"
#include "tools/base/text.h"

namespace sim {
namespace {

constexpr std::size_t kMostProblems = 20;  // enough to identify the file's format

void ThrowIfAny(std::vector<settings::Problem> problems, const std::filesystem::path& file) {
  if (problems.size() > kMostProblems) {
    problems.resize(kMostProblems);
    problems.push_back({file.string(), 0, 0, "further problems are not listed", {}});
  }
  if (!problems.empty()) throw settings::Error(std::move(problems));
}

// Within 1 cm and 1 degree: motion capture that is rounded to 0.1 ms has stamps twice.
bool IsSamePose(const Pose& a, const Pose& b) {
  constexpr double kSamePosition = 0.01, kSameHalfAngle = 0.5 * 0.017453292519943;
  return glm::distance(a.p_WC, b.p_WC) <= kSamePosition &&
         std::abs(glm::dot(a.q_WC, b.q_WC)) >= std::cos(kSameHalfAngle);
}

[[noreturn]] void Fail(const std::filesystem::path& file, const std::string& message) {
  throw settings::Error({{file.string(), 0, 0, message, {}}});
}

}  // namespace

std::vector<KeyPose> ReadTumTrajectory(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    Fail(file, std::string("cannot be read: ") + std::strerror(errno ? errno : EISDIR));
  std::vector<settings::Problem> problems;
  const auto add = [&](int line, int column, std::string message) {
    problems.push_back({file.string(), line, column, std::move(message), {}});
  };
  std::vector<KeyPose> keys;
  std::int64_t first_ns = 0, last_ns = 0;
  base::PoseTable table;
  int last_line = 0, number = 0;
  for (std::string line; problems.size() <= kMostProblems && std::getline(stream, line);) {
    ++number;
    if (const std::string problem = number == 1 ? base::TextProblem(line) : ""; !problem.empty()) Fail(file, problem);
    std::string other_kind;
    const std::vector<base::Word> words = table.Row(number == 1 ? base::WithoutMark(line) : line, other_kind);
    if (!other_kind.empty()) {
      add(number, 1, other_kind);
      break;
    }
    if (words.empty()) continue;
    if (words.size() != 8) {
      add(number, 1, "expected timestamp tx ty tz qx qy qz qw, not " + std::to_string(words.size()) + " words");
      continue;
    }
    const std::optional<std::int64_t> stamp = base::ParseSeconds(table.Stamp(words[0]));
    bool good = stamp.has_value();
    if (!good) add(number, words[0].column, "'" + std::string(words[0].text) + "' is not a timestamp in seconds");
    double v[7] = {};
    for (std::size_t i = 0; i < 7; ++i) {
      std::string problem;
      if (settings::ParseQuantity(words[i + 1].text, settings::Unit::none, {}, v[i], problem)) continue;
      add(number, words[i + 1].column, problem);
      good = false;
    }
    if (!good) continue;
    const glm::dquat q(v[6], v[3], v[4], v[5]);
    if (!(std::abs(glm::length(q) - 1) <= 1e-3)) {
      add(number, words[4].column, "the quaternion's length is " + settings::FormatNumber(glm::length(q)) + ", not 1");
    }
    const std::int64_t stamp_ns = *stamp;
    if (last_line > 0 && stamp_ns == last_ns && IsSamePose({{v[0], v[1], v[2]}, q}, keys.back().pose)) continue;
    if (last_line > 0 && stamp_ns <= last_ns) {
      add(number, words[0].column,
          "time " + std::string(words[0].text) + " is not after that of line " + std::to_string(last_line));
    }
    if (last_line == 0) first_ns = stamp_ns;
    last_line = number;
    last_ns = stamp_ns;
    keys.push_back({static_cast<double>(stamp_ns - first_ns) * 1e-9, {{v[0], v[1], v[2]}, q}});
  }
  if (stream.bad()) add(0, 0, "cannot be read to its end");
  ThrowIfAny(std::move(problems), file);
  if (keys.size() < 2) Fail(file, "holds " + std::to_string(keys.size()) + " poses; a motion needs two at least");
  for (KeyPose& key : keys) key.pose.q_WC = glm::normalize(key.pose.q_WC);
  return keys;
}

std::vector<KeyPose> Average(const std::vector<KeyPose>& keys, double average_s) {
  if (!(average_s > 0)) return keys;
  std::vector<KeyPose> means;
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    const double interval = std::floor(keys[first].t_s / average_s);
    KeyPose sum{0, {glm::dvec3(0), glm::dquat(0, 0, 0, 0)}};
    for (; last < keys.size() && std::floor(keys[last].t_s / average_s) == interval; ++last) {
      const glm::dquat& q = keys[last].pose.q_WC;
      sum.t_s += keys[last].t_s;
      sum.pose.p_WC += keys[last].pose.p_WC;
      sum.pose.q_WC = sum.pose.q_WC + (glm::dot(keys[first].pose.q_WC, q) < 0 ? -q : q);
    }
    const double count = static_cast<double>(last - first);
    means.push_back({sum.t_s / count, {sum.pose.p_WC / count, glm::normalize(sum.pose.q_WC)}});
  }
  return means;
}

std::unique_ptr<Trajectory> MakeRecordedTrajectory(const RecordedMotion& motion, double end_s, std::uint64_t seed,
                                                   const Surroundings* around) {
  if (!motion.place.empty() && !std::filesystem::exists(motion.file))
    Fail(motion.place, motion.file.string() + ": no such file");
  std::vector<KeyPose> keys = ReadTumTrajectory(motion.file);
  const double length_s = keys.back().t_s;
  constexpr double kRounding_s = 0.5e-9;  // stamps are whole nanoseconds
  if (!(motion.start_time_s >= 0) || !(motion.start_time_s + end_s <= length_s + kRounding_s)) {
    Fail(motion.file, "lasts " + settings::FormatNumber(length_s) + " s; asked for is " +
                          settings::FormatNumber(motion.start_time_s) + " s to " +
                          settings::FormatNumber(motion.start_time_s + end_s) + " s");
  }
  keys = Average(keys, motion.averaging_time_s);
  for (KeyPose& key : keys) key.t_s -= motion.start_time_s;
  const auto make = [&] {
    try {
      return std::make_unique<SplineTrajectory>(keys);
    } catch (const std::invalid_argument& error) {
      Fail(motion.file, error.what());
    }
  };
  std::unique_ptr<Trajectory> trajectory = make();
  std::optional<Pose> start = motion.start_pose;
  if (motion.placing == RecordedMotion::Placing::automatic) {
    if (around == nullptr) Fail(motion.file, "'placing: auto' needs a world of meshes");
    try {
      std::vector<Pose> poses;  // a number coprime to the 37 of FreePlaceOf
      for (int k = 0; k < 120; ++k) poses.push_back(trajectory->At(end_s * k / 119).pose);
      start = FreePlaceOf(std::move(poses), motion.clearance, *around, seed);
    } catch (const std::invalid_argument& error) {
      Fail(motion.file, error.what());
    }
  }
  if (!start) return trajectory;
  // T = place * first^-1, applied from the left: the path keeps its shape.
  const Pose first = trajectory->At(0).pose;
  const glm::dquat turn = glm::normalize(start->q_WC) * glm::conjugate(first.q_WC);
  for (KeyPose& key : keys) {
    key.pose = {start->p_WC + turn * (key.pose.p_WC - first.p_WC), glm::normalize(turn * key.pose.q_WC)};
  }
  return make();
}

}  // namespace sim
