// External odometry: an entry of systems.yaml, with its command (docs/campaign.md).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tools/judge/evaluation/ate.h"

namespace vobench::campaign {

enum class SequenceLayout {
  tum,     // rgb.txt and rgb/
  euroc,   // mav0/cam0/, and of those who take more mav0/cam1/, mav0/imu0/
  images,  // images/000000.png, ... and times.txt: `000000 timestamp exposure`
};

enum class CalibrationFormat { none, camera_yaml, orb_slam2, orb_slam3, dso, svo, lsd_slam };

// Sensors beside the first camera.
struct Sensors {
  bool stereo = false, imu = false;
  bool metric() const { return stereo || imu; }  // the scale is known
  bool operator==(const Sensors&) const = default;
};

std::string Name(SequenceLayout layout);
// "mono", "stereo", "mono_imu", "stereo_imu".
std::string Name(const Sensors& sensors);
std::string Name(CalibrationFormat format);

struct ExternalSystem {
  std::string name;
  // For sh, in an empty folder of its own. {sequence}, {calibration}, {configs}, {trajectory}, {seed}, {here} (the
  // folder of systems.yaml) and the variables are replaced by their values, quoted.
  std::string command;
  std::vector<std::pair<std::string, std::string>> variables;
  Sensors sensors;
  std::string configs;  // such a command that first writes configuration files into {configs}; empty: none
  SequenceLayout layout = SequenceLayout::tum;
  CalibrationFormat calibration = CalibrationFormat::none;
  bool rectified = false;                     // pictures and calibration of a pinhole
  std::string trajectory = "trajectory.txt";  // that it writes, in TUM format: T_WC; relative to its folder
  bool poses_of_imu = false;                  // T_WI instead
  evaluation::Alignment align = evaluation::Alignment::sim3;  // of a metric one: se3, or yaw where z is up in its world
  double timeout_s = 3600;
  bool keyframes = false;         // it writes key frames only: evaluated at their stamps, and marked in tables
  bool accepts_any_exit = false;  // a trajectory counts whatever the exit status is
  int threads = 1;                // that it keeps busy, of those of `--jobs`
  std::vector<std::filesystem::path> files;  // whose bytes are part of it, beside those that the command names
  std::string programs;                      // DigestOfPrograms
};

// The entries, in order. Throws settings::Error with every problem: a repeated name, an unknown placeholder.
std::vector<ExternalSystem> ReadExternalSystems(const std::filesystem::path& file);

// The command with each placeholder replaced by its value, quoted for sh.
std::string FillIn(const std::string& command, const std::vector<std::pair<std::string, std::string>>& values);

// "name", or "name (key frames)": in tables.
std::string Label(const ExternalSystem& system, const std::string& name);

// Why sh could not start the command here, or its interpreter not find the script; empty where they can, or where that
// cannot be decided in advance.
std::string StartProblem(const ExternalSystem& system);

// Digest of the bytes of `files` and of each file that the command names.
std::string DigestOfPrograms(const ExternalSystem& system);
// All inputs that an answer depends on, as one text.
std::string Description(const ExternalSystem& system);

}  // namespace vobench::campaign
