// ROS 1 bag, written message by message with Debian's rosbag storage library, whose headers are not C++20: this is
// compiled as C++17.
// Source: ROS bag format 2.0; sensor_msgs, geometry_msgs; REP 103 (units, optical frames), 104 (camera_info), 118.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vobench {

// Written under a hidden name beside the file, and renamed by Commit. Throws std::runtime_error naming the file. Stamps
// at least 1 ns: a bag has no time 0.
class BagFile {
 public:
  BagFile(const std::string& file, const std::string& name);
  ~BagFile();

  struct Picture {
    std::uint32_t width = 0, height = 0, bytes_per_pixel = 0;
    std::string encoding;  // bgr8, mono8, 32FC1
    const std::uint8_t* data = nullptr;
  };
  struct Lens {
    std::uint32_t width = 0, height = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    std::string model;  // plumb_bob, equidistant
    std::vector<double> coefficients;
  };
  void Image(const std::string& topic, std::int64_t stamp_ns, const Picture& picture);
  void CameraInfo(const std::string& topic, std::int64_t stamp_ns, const Lens& lens);
  void Imu(const std::string& topic, std::int64_t stamp_ns, const std::array<double, 3>& angular_rate,
           const std::array<double, 3>& specific_force);
  // T_WC: position, quaternion x y z w.
  void Pose(const std::string& topic, std::int64_t stamp_ns, const std::array<double, 3>& p,
            const std::array<double, 4>& q);
  void Close();

  // Message counts by topic of a bag that is there, "TOPIC TYPE COUNT" each, as the library reads them back.
  static std::vector<std::string> Topics(const std::string& file);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vobench
