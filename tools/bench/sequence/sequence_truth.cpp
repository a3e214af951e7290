#include "tools/bench/sequence/sequence_truth.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/base/settings/settings.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"
#include "vo/sequence/reader.h"

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

// ICL-NUIM's time is index / 30 s. indices_ns: the index read as seconds.
std::int64_t IclNuimStamp(std::int64_t indices_ns) { return (indices_ns + 15) / 30; }

// The table's poses are the body's. The camera's is T_RB T_BC.
evaluation::Trajectory ReadEurocTruth(const fs::path& file, const fs::path& camera) {
  const Eigen::Isometry3d T_BC = ReadExtrinsic(camera);
  evaluation::Trajectory poses = evaluation::ReadTrajectory(file, evaluation::Reading::euroc);
  for (evaluation::StampedPose& pose : poses) {
    const Eigen::Isometry3d T_RC = Eigen::Translation3d(pose.p_WC) * pose.q_WC * T_BC;
    pose.p_WC = T_RC.translation();
    pose.q_WC = Eigen::Quaterniond(T_RC.linear());
  }
  return poses;
}

}  // namespace

Eigen::Isometry3d ReadExtrinsic(const fs::path& file) {
  std::array<double, 16> data{};
  settings::Document document = settings::Document::FromFile(file);
  settings::Section root = document.root(), T_BS = root.Child("T_BS");
  T_BS.Require("data", data);
  T_BS.IgnoreRest();
  root.IgnoreRest();
  document.ThrowIfBad();
  Eigen::Isometry3d T;
  T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  return T;
}

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
  for (const char* sensor : {"state_groundtruth_estimate0", "mocap0"}) {  // of EuRoC, of TUM VI
    const fs::path table = sequence / "mav0" / sensor / "data.csv";
    if (!fs::exists(table)) continue;
    truth.poses = ReadEurocTruth(table, sequence / "mav0/cam0/sensor.yaml");
    return truth;
  }
  const std::optional<fs::path> icl_nuim = IclNuimTruth(sequence);
  if (!icl_nuim) return std::nullopt;
  truth.poses = MirroredInY(evaluation::ReadTrajectory(*icl_nuim));
  for (evaluation::StampedPose& pose : truth.poses) pose.stamp_ns = IclNuimStamp(pose.stamp_ns);
  fmt::print(stderr, "{}: original ICL-NUIM truth, mirrored in y to match a camera with fy > 0; time is index / 30 s\n",
             icl_nuim->string());
  return truth;
}

std::optional<std::vector<std::int64_t>> ReadFrameStamps(const fs::path& sequence) {
  constexpr const char* kLists[] = {"rgb.txt", "associations.txt", "association.txt", "associate.txt",
                                    "mav0/cam0/data.csv"};
  if (std::ranges::none_of(kLists, [&](const char* list) { return fs::exists(sequence / list); })) return std::nullopt;
  const vo::SequenceReader reader(sequence, vo::SequenceReader::Images::not_asked_for);
  std::vector<std::int64_t> stamps;
  for (const vo::SequenceReader::Entry& frame : reader.entries()) stamps.push_back(frame.stamp_ns);
  return stamps;
}

}  // namespace vobench
