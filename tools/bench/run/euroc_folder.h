// mav0/ of a sequence in EuRoC's layout, with links to pictures stored elsewhere, and without the truth.
// Source: Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "sim/simulator.h"
#include "tools/bench/campaign/external_system.h"
#include "vo/sequence/reader.h"

namespace vobench {

using SequenceFrames = std::vector<vo::SequenceReader::Entry>;

// FOLDER/mav0/camK: data.csv, sensor.yaml of scenario.camera, and links in data/. Throws BadInput for a lens that the
// format does not support.
void WriteEurocCamera(const std::filesystem::path& folder, const sim::Scenario& scenario, const SequenceFrames& frames,
                      std::size_t k);

// mav0/ beside a sequence in TUM's layout that was rendered into `folder` (a rig's with stereo); and, of a rig, the
// first camera's files in the place of a single camera's. imu0/sensor.yaml contains the magnitude of gravity, too.
void AddRendered(const std::filesystem::path& folder, const sim::Simulator& simulator, campaign::Sensors sensors);

// Sensors of a recorded sequence beside its first camera.
struct RecordedSensors {
  std::filesystem::path mav;  // mav0/ of the recording
  SequenceFrames second;      // of cam1, as long as the first camera's are used
  bool imu = false;           // all readings of imu0
  campaign::Sensors has() const { return {!second.empty(), imu}; }
  std::vector<std::string> files() const;  // in `mav`, all but the pictures
};
// Of those that are wanted. Throws std::runtime_error where a list cannot be read.
RecordedSensors ReadSensors(const std::filesystem::path& sequence, const SequenceFrames& frames,
                            campaign::Sensors wanted);
// mav0/ of cam0 with these frames, and of the others, with the recording's own sensor.yaml files.
void AddRecorded(const std::filesystem::path& folder, const SequenceFrames& frames, const RecordedSensors& sensors);

// T_IC of cam0 in a folder with mav0/: maps points from C to the IMU. Throws settings::Error.
Eigen::Isometry3d CameraInImu(const std::filesystem::path& folder);

}  // namespace vobench
