// Trajectory from a recording in the TUM format.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "sim/motion/description.h"
#include "sim/motion/trajectory.h"

namespace sim {

// The poses of a table (tools/base/pose_table.h), of EuRoC's the body's path; times are counted from the first stamp.
// Throws settings::Error with all problems, file:line each (the first 20): a line without eight finite numbers, times
// that do not increase (but for a second line of the same pose), a quaternion whose length is not 1 within 1e-3 (it is
// normalised), fewer than two poses, an unreadable file.
std::vector<KeyPose> ReadTumTrajectory(const std::filesystem::path& file);

// The mean stamp, position and orientation of the poses in each interval [k average_s, (k + 1) average_s) that has any.
// Stamps of motion capture are uneven by milliseconds, some fall together: a curve through every pose would jerk.
std::vector<KeyPose> Average(const std::vector<KeyPose>& keys, double average_s);

// A spline (sim/motion/spline.h) through the averaged poses, moved in time and space as described; up to average_s at
// the file's ends it is extrapolated at constant velocity. Remaining noise of the recording is part of the true motion.
// Throws settings::Error as above; when it is to be placed automatically and there is no such place (placement.h) or no
// world; and when the recording ends before end_s or turns too fast for a spline.
std::unique_ptr<Trajectory> MakeRecordedTrajectory(const RecordedMotion& motion, double end_s, std::uint64_t seed = 1,
                                                   const Surroundings* around = nullptr);

}  // namespace sim
