// ROS 1 bag, written message by message with Debian's rosbag storage library, whose headers need C++17.
// Source: ROS bag format 2.0; sensor_msgs, geometry_msgs; REP 103 (units, optical frames), 104 (camera_info), 118.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "tools/judge/evaluation/trajectory.h"
#include "vo/geometry/camera.h"

namespace vobench {

// Written under a hidden name beside the file, and renamed by Commit. Throws std::runtime_error naming the file. Stamps
// at least 1 ns: a bag has no time 0.
class BagFile {
 public:
  BagFile(const std::string& file, const std::string& name);
  ~BagFile();

  // encoding: bgr8, mono8, 32FC1.
  void Image(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& image, const char* encoding);
  void CameraInfo(const std::string& topic, std::int64_t stamp_ns, const vo::Camera& camera);
  void Imu(const std::string& topic, std::int64_t stamp_ns, const Eigen::Vector3d& angular_rate,
           const Eigen::Vector3d& specific_force);
  void Pose(const std::string& topic, std::int64_t stamp_ns, const evaluation::StampedPose& T_WC);
  void Close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vobench
