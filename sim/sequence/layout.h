// File layouts and text formats of a sequence (docs/sequence_format.md).
// Source: TUM RGB-D benchmark (Sturm et al. 2012); EuRoC MAV dataset in ASL's format (Burri et al. 2016); ICL-NUIM
//   (Handa et al. 2014).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/motion/trajectory.h"
#include "sim/scenario/scenario.h"
#include "sim/sensor/exposure.h"
#include "sim/sequence/encode.h"

namespace sim {

enum class Layout { tum, euroc, icl };

std::string ToString(Layout layout);

// Elements of the scenario that the layout cannot represent, one sentence each: EuRoC's camera has no k3, ICL-NUIM's
// time is index / 30 s.
std::vector<std::string> Problems(Layout layout, const Scenario& scenario);

// Of a frame's pictures, relative to the sequence's folder.
struct FrameNames {
  std::string image, depth;
};
FrameNames NamesOf(Layout layout, std::int64_t index, std::int64_t stamp_ns, std::size_t camera = 0);

struct StampedTruth {
  std::int64_t index = 0;
  std::int64_t stamp_ns = 0;
  Truth truth;
  glm::dvec3 gyroscope_bias{0.0}, accelerometer_bias{0.0};  // of the IMU, in I
};
// EuRoC's body frame S and its world R. With an IMU, S is the IMU and gravity is along -z; without, S is the camera (of
// a rig, the body) and R the scenario's world.
struct EurocBody {
  explicit EurocBody(const Scenario& scenario);
  Pose T_BS;  // maps points from S to the scenario's body
  glm::dquat q_RW{1.0, 0.0, 0.0, 0.0};
  Pose OfCamera(const Scenario& scenario, std::size_t camera) const;  // T_SC
};

// Lists of a camera's frames and truth, with a line for each of `frames`, in order of time; and its sensor files.
std::vector<StreamFile> Lists(Layout layout, const Scenario& scenario, std::span<const StampedTruth> frames,
                              std::size_t camera = 0);
// The truth of the body, in EuRoC's form (of S, in R), or TUM's, which only a rig has; and files that exist once.
std::vector<StreamFile> BodyLists(Layout layout, const Scenario& scenario, std::span<const StampedTruth> body);

// Twelve decimals, finer than any rounding that matters; a negative zero loses its sign.
std::string FormatDecimal(double number);
// "stamp tx ty tz qx qy qz qw" and "stamp vx vy vz wx wy wz", with the newline.
std::string TruthLine(std::int64_t stamp_ns, const Truth& truth);
std::string VelocityLine(std::int64_t stamp_ns, const Truth& truth);
// "stamp ax ay az alphax alphay alphaz", the same.
std::string AccelerationLine(std::int64_t stamp_ns, const Truth& truth);
// "stamp exposure gain", the time in seconds.
std::string ExposureLine(std::int64_t stamp_ns, const ExposureSetting& setting);
// "position: [x, y, z]" and "orientation: [x, y, z, w]".
std::string PlaceYaml(const Pose& pose, const std::string& between);
// readout_s: of the rolling shutter, 0: a global one; none: not stated.
std::string CameraYaml(const CameraParams& camera, std::optional<double> readout_s);

}  // namespace sim
