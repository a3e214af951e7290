// External odometry: an entry of systems.yaml, with its command (docs/campaign.md).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace vobench::campaign {

enum class SequenceLayout {
  tum,     // rgb.txt and rgb/
  euroc,   // mav0/cam0/
  images,  // images/000000.png, ... and times.txt: `000000 timestamp exposure`
};

enum class CalibrationFormat { none, camera_yaml, orb_slam2, orb_slam3, dso, svo, lsd_slam };

std::string Name(SequenceLayout layout);
std::string Name(CalibrationFormat format);

struct ExternalSystem {
  std::string name;
  // For sh, in an empty folder of its own. {sequence}, {calibration}, {trajectory}, {seed} and the variables stand for
  // what they say, quoted.
  std::string command;
  std::vector<std::pair<std::string, std::string>> variables;
  SequenceLayout layout = SequenceLayout::tum;
  CalibrationFormat calibration = CalibrationFormat::none;
  std::string trajectory = "trajectory.txt";  // that it writes, in TUM format: T_WC; relative to its folder
  double timeout_s = 3600;
};

// The entries, in order. Throws settings::Error with every problem: a repeated name, an unknown placeholder.
std::vector<ExternalSystem> ReadExternalSystems(const std::filesystem::path& file);

// What a placeholder stands for is put in its place, quoted for sh.
std::string FillIn(const std::string& command, const std::vector<std::pair<std::string, std::string>>& values);

// All that an answer depends on, as one text.
std::string Description(const ExternalSystem& system);

}  // namespace vobench::campaign
