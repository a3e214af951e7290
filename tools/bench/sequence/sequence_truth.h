// Ground truth and frame stamps of a sequence on disk, for evaluation only.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/bench/points/truth.h"

namespace vobench {

// groundtruth.txt (and velocity.txt) of docs/sequence_format.md; or the *.gt.freiburg of an original ICL-NUIM folder,
// whose poses belong to a camera with fy < 0: they are mirrored in y (S T S with S = diag(1, -1, 1)), their time is
// index / 30 s, and a line on stderr says so; or the truth of a EuRoC folder, of cam0 (its body's pose times T_BS of
// cam0). None when there is none of them. Throws evaluation::InputError or settings::Error.
std::optional<Truth> ReadSequenceTruth(const std::filesystem::path& sequence);

// Stamps of the pictures that the sequence lists: in rgb.txt, ICL-NUIM's associations.txt (index / 30 s) or EuRoC's
// mav0/cam0/data.csv. None where it has no list. Throws std::runtime_error.
std::optional<std::vector<std::int64_t>> ReadFrameStamps(const std::filesystem::path& sequence);

// T_BS of a EuRoC sensor.yaml: maps points from the sensor's frame to the body's. Throws settings::Error.
Eigen::Isometry3d ReadExtrinsic(const std::filesystem::path& file);

// S T S: the same trajectory as seen by a camera whose image is the right way up.
evaluation::Trajectory MirroredInY(evaluation::Trajectory trajectory);

}  // namespace vobench
