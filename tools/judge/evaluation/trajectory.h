// Trajectories and velocities for the evaluation, read from and written to text files.
// Source: docs/conventions.md (frames, units), docs/sequence_format.md (files); the TUM RGB-D trajectory format.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace evaluation {

// T_WC at a time: X_W = q_WC * X_C + p_WC.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();            // [m]
  Eigen::Quaterniond q_WC = Eigen::Quaterniond::Identity();  // unit
};

// In order of time.
using Trajectory = std::vector<StampedPose>;

struct StampedVelocity {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();    // of the camera centre, in W [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();  // angular velocity of C against W, in C [rad/s]
};

// vx vy vz wx wy wz.
std::array<double, 6> NumbersOf(const StampedVelocity& velocity);

using Velocities = std::vector<StampedVelocity>;

// as_written: quaternions keep their norm and of equal stamps all lines are kept, for tools that read so. euroc:
// EuRoC's column order, whatever the header.
enum class Reading { strict, as_written, euroc };

// Reads a table of poses (tools/base/pose_table.h), EuRoC's unchanged: of the body. Quaternions are normalised; a norm
// that differs from 1 by more than 1e-3 is an error (recorded truth is rounded to four digits, which leaves up to
// 1e-4). Time must not decrease. Of lines with equal stamps the first is kept: motion-capture truth rounded to 0.1 ms
// has such lines; a second one that differs by more than 1 cm or 1 degree from the first is an error. Throws InputError
// with every problem as file:line:column, and when no pose is left.
Trajectory ReadTrajectory(const std::filesystem::path& file, Reading reading = Reading::strict);

// Writes the same: stamps with nine decimals, twelve significant digits, qw >= 0. Throws std::invalid_argument naming
// the pose when a number is not finite or time does not increase, std::runtime_error when the file cannot be written
// whole.
void WriteTrajectory(const std::filesystem::path& file, const Trajectory& trajectory);

// `timestamp vx vy vz wx wy wz`, as strictly; time must increase.
Velocities ReadVelocities(const std::filesystem::path& file);
void WriteVelocities(const std::filesystem::path& file, const Velocities& velocities);

// The velocity at exactly this time, if there is one (stamps of one frame are identical in all files of a sequence).
std::optional<StampedVelocity> VelocityAt(const Velocities& velocities, std::int64_t stamp_ns);

// Path length through the positions up to each pose [m]; the first is 0.
std::vector<double> CumulativePathLength(const Trajectory& trajectory);

// Path length through all positions [m].
double PathLength(const Trajectory& trajectory);

// RMS distance of the positions from their mean [m]; 0 without positions.
double Spread(const Trajectory& trajectory);

}  // namespace evaluation
