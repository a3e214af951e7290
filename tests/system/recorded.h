// Runs of the program on recorded sequences, which are not part of the project: in $VOBENCH_DATA, or else in
// ../shared/data beside the checkout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vobench::system_test {

// Folder of a sequence, if it is there.
std::optional<std::filesystem::path> RecordedSequence(const std::string& name);

// Writes the frames [first, last) of a sequence to `folder`. Images are linked, truth is copied.
void SomeFrames(const std::filesystem::path& sequence, int first, int last, const std::filesystem::path& folder);

// Metrics of one `vobench track`, from metrics.json.
struct Scores {
  double ate_cm = 0, constant_pose_ate_cm = 0, constant_velocity_ate_cm = 0;  // position RMSE after Sim(3)
  double rpe_cm_per_s = 0;
  double pose_coverage = 0, tracked_coverage = 0;
};

// Throws std::runtime_error with the program's message when it fails.
Scores TrackRecorded(const std::filesystem::path& sequence, const std::string& camera, std::uint64_t seed,
                     const std::vector<std::string>& settings = {});  // KEY=VALUE

}  // namespace vobench::system_test
