#include "tools/vobench/sequence_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace vobench {
namespace fs = std::filesystem;
namespace {

std::optional<fs::path> IclNuimTruth(const fs::path& sequence) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(sequence)) {
    if (entry.path().string().ends_with(".gt.freiburg")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files.empty() ? std::nullopt : std::optional(files.front());
}

}  // namespace

evaluation::Trajectory MirroredInY(evaluation::Trajectory trajectory) {
  for (evaluation::StampedPose& pose : trajectory) {
    pose.p_WC.y() = -pose.p_WC.y();
    pose.q_WC.x() = -pose.q_WC.x();  // a rotation's axis is a pseudo-vector
    pose.q_WC.z() = -pose.q_WC.z();
  }
  return trajectory;
}

std::optional<Truth> ReadSequenceTruth(const fs::path& sequence) {
  Truth truth;
  if (fs::exists(sequence / "groundtruth.txt")) {
    truth.poses = evaluation::ReadTrajectory(sequence / "groundtruth.txt");
    if (fs::exists(sequence / "velocity.txt")) truth.velocities = evaluation::ReadVelocities(sequence / "velocity.txt");
    return truth;
  }
  if (!fs::is_directory(sequence)) return std::nullopt;
  const std::optional<fs::path> icl_nuim = IclNuimTruth(sequence);
  if (!icl_nuim) return std::nullopt;
  truth.poses = MirroredInY(evaluation::ReadTrajectory(*icl_nuim));
  for (evaluation::StampedPose& pose : truth.poses) pose.stamp_ns = (pose.stamp_ns + 15) / 30;  // was: index as seconds
  fmt::print(stderr, "{}: original ICL-NUIM truth, mirrored in y to match a camera with fy > 0; time is index / 30 s\n",
             icl_nuim->string());
  return truth;
}

}  // namespace vobench
