// Files of a sequence (docs/sequence_format.md, docs/truth.md), read from their formats alone.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/judge/verification/check.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/pose.h"

namespace verification {

// `timestamp filename`, or `timestamp numbers`.
struct Entry {
  std::int64_t stamp_ns = 0;
  std::string file;
  std::vector<double> numbers;
};

// Roughness of the path between two stamps, from the manifest. Absent: taken for smooth.
struct Roughness {
  bool sampled = false;                  // from white acceleration, between knots by cubics
  double position = 0, orientation = 0;  // its density: square roots of power spectral densities [m/s^1.5, rad/s^1.5]
  double knot_step_s = 0;
};

// A moving object, by objects/NAME.txt: T_WO at the frames' stamps.
struct Object {
  std::string name;
  std::vector<vo::Pose> poses;  // the identity where there is none
  std::vector<bool> has_pose;
};

struct Imu {
  double rate_hz = 200;
  vo::Pose T_CI;
  Eigen::Vector3d gravity_W{0, -9.81, 0};
  bool mean = false;
  double gyroscope_noise = 0, accelerometer_noise = 0, gyroscope_walk = 0, accelerometer_walk = 0;
  std::vector<Entry> readings;  // six numbers each: w_I, f_I
};

struct Sequence {
  std::filesystem::path folder;
  vo::Camera camera;
  std::map<std::string, std::vector<Entry>> images;  // by list, without ".txt": rgb, depth, flow, ...; boxes
  std::map<std::string, std::vector<Entry>> texts;   // groundtruth, velocity, acceleration, objects/NAME
  std::vector<std::int64_t> stamps;                  // of the frames: those on which most lists agree
  std::vector<vo::Pose> poses;                       // of the frames; the identity where there is none
  std::vector<bool> has_pose;
  std::vector<Object> objects;
  Roughness roughness;
  bool rolling_shutter = false;  // from the manifest: each row has its own time
  std::size_t surfaces = 0;      // how many the legend has, whose ids are 1, 2, ...
  std::vector<int> classes;      // of each instance, by the legend of labels, whose ids are 1, 2, ...; of 0: 0
  std::vector<Entry> landmarks;  // numbers: id, position, surface id; the stamp is 0
  std::vector<Entry> tracks;     // numbers: id, u, v, visible
  bool has_imu = false;
  Imu imu;

  // The file of a stream at a frame; empty when there is none.
  std::string FileAt(const std::string& stream, std::size_t frame) const;
};

// A camera of a rig, by rig.yaml. T_BC maps points from C to the body B.
struct RigCamera {
  std::string name;
  vo::Pose T_BC;
  double trigger_offset_s = 0;
};

// None where the folder has no rig.yaml. Throws std::runtime_error for a bad one.
std::vector<RigCamera> ReadRig(const std::filesystem::path& folder);

// `timestamp` and so many numbers, or a file name (numbers = 0), on each line. separator ',': stamps in nanoseconds.
std::vector<Entry> ReadTable(const std::filesystem::path& file, std::size_t numbers, bool stamped, bool increasing,
                             char separator, Check& files);

// Reads all text files. Malformed lines are failures of `files`, lists that disagree in their stamps one of `stamps`,
// both with file and line. Throws std::runtime_error where there is no sequence at all: no folder, no rgb.txt, no
// groundtruth.txt, no camera.yaml, or a camera of more pixels than a picture may have.
// `manifest`: the folder that has it.
Sequence ReadSequence(const std::filesystem::path& folder, const std::filesystem::path& manifest, Check& files,
                      Check& stamps);
// Poses, velocities and IMU of a rig's body, as a sequence without pictures.
Sequence ReadBody(const std::filesystem::path& folder, Check& files);

// The class of each instance by labels.json, 0 of instance 0. Throws std::runtime_error.
std::vector<int> ReadLegend(const std::filesystem::path& file);

// One picture: 8-bit (grey or colour) and 16-bit PNG unconverted, EXR as CV_32FC1 or CV_32FC3 (R, G, B), .flo as
// CV_32FC2. Throws std::runtime_error naming the file.
cv::Mat ReadPicture(const std::filesystem::path& file);

}  // namespace verification
