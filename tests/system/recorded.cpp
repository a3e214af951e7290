#include "tests/system/recorded.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "source_dir.h"
#include "tests/system/program.h"

namespace vobench::system_test {
namespace fs = std::filesystem;

std::optional<fs::path> RecordedSequence(const std::string& name) {
  const char* given = std::getenv("VOBENCH_DATA");
  const fs::path data =
      given != nullptr ? fs::path(given) : fs::path(VOBENCH_SOURCE_DIR).parent_path() / "shared" / "data";
  const fs::path folder = data / name;
  return fs::exists(folder / "rgb.txt") ? std::optional(folder) : std::nullopt;
}

void SomeFrames(const fs::path& sequence, int first, int last, const fs::path& folder) {
  std::istringstream list(ReadFile(sequence / "rgb.txt"));
  std::string line, kept;
  for (int frame = 0; frame < last && std::getline(list, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (frame >= first) kept += line + "\n";
    ++frame;
  }
  WriteFile(folder / "rgb.txt", kept);
  fs::copy_file(sequence / "groundtruth.txt", folder / "groundtruth.txt");
  fs::create_directory_symlink(fs::canonical(sequence / "rgb"), folder / "rgb");
}

Scores TrackRecorded(const fs::path& sequence, const std::string& camera, std::uint64_t seed,
                     const std::vector<std::string>& settings) {
  const TemporaryFolder here;
  std::vector<std::string> arguments{"track",  sequence.string(),   "-o", "out", "--camera", camera,
                                     "--seed", std::to_string(seed)};
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  const Outcome outcome = RunVobench(arguments, here.path());
  if (outcome.status != 0) throw std::runtime_error(outcome.err);
  const nlohmann::json metrics = nlohmann::json::parse(ReadFile(here / "out/metrics.json"));
  const auto value = [](const nlohmann::json& system, const char* key) {
    return system.at(key).at("value").get<double>();
  };
  const nlohmann::json& system = metrics.at("systems").at(0);
  Scores scores;
  scores.ate_cm = 100 * value(system, "ate");
  scores.rpe_cm_per_s = 100 * value(system, "rpe_position");
  scores.pose_coverage = value(system, "pose_coverage");
  scores.tracked_coverage = value(system, "tracked_coverage");
  for (const nlohmann::json& baseline : metrics.at("baselines")) {
    (baseline.at("system") == "constant pose" ? scores.constant_pose_ate_cm : scores.constant_velocity_ate_cm) =
        100 * value(baseline, "ate");
  }
  return scores;
}

}  // namespace vobench::system_test
