// Recordings of ROS messages, written message by message: ROS 1 bags, and MCAP with the messages of ROS 2.
// Source: ROS bag format 2.0; MCAP format 0 (mcap.dev/spec); sensor_msgs, geometry_msgs of ROS 1 and of ROS 2, whose
//   messages are CDR (OMG DDS-RTPS 2.2); REP 103 (units, optical frames), 104 (camera_info), 118 (depth).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "tools/base/files.h"
#include "tools/judge/evaluation/trajectory.h"
#include "vo/geometry/camera.h"

namespace vobench {

struct RosType;
class RosMessage;

// The file appears with Close. Messages are added in order of time. Throws std::runtime_error naming the file.
class MessageFile {
 public:
  virtual ~MessageFile() = default;

  // The first part of a topic is the frame of its header. encoding: bgr8, mono8, 32FC1.
  void Image(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& image, const char* encoding);
  void CameraInfo(const std::string& topic, std::int64_t stamp_ns, const vo::Camera& camera);
  void Imu(const std::string& topic, std::int64_t stamp_ns, const std::vector<double>& rate_and_force);
  void Pose(const std::string& topic, std::int64_t stamp_ns, const evaluation::StampedPose& T_WC);
  void Close();

 protected:
  struct Channel {
    std::string topic;
    const RosType* type;
    std::uint64_t count = 0;  // of all messages
  };
  struct Indexed {
    std::int64_t stamp_ns;
    std::uint64_t offset;  // in the chunk's records
  };
  struct Chunk {
    std::string records;
    std::int64_t first_ns = 0, last_ns = 0;
    std::map<std::uint32_t, std::vector<Indexed>> index;  // by channel
  };

  MessageFile(const std::filesystem::path& file, bool ros2) : file_(file), ros2_(ros2) {}
  void Append(const std::string& bytes);
  virtual std::string ConnectionRecord(std::uint32_t channel) const = 0;
  virtual std::string MessageRecord(std::uint32_t channel, std::int64_t stamp_ns, const std::string& message) const = 0;
  virtual void Write(const Chunk& chunk) = 0;
  virtual void WriteEnd() = 0;

  base::AtomicFile file_;
  std::uint64_t position_ = 0;
  std::vector<Channel> channels_;

 private:
  RosMessage Begin(const std::string& frame, std::int64_t stamp_ns) const;
  void Add(const std::string& topic, const RosType& type, std::int64_t stamp_ns, const RosMessage& message);

  bool ros2_;
  Chunk chunk_;
};

// Stamps at least 1 ns: a bag has no time 0.
std::unique_ptr<MessageFile> MakeBag(const std::filesystem::path& file);
std::unique_ptr<MessageFile> MakeMcap(const std::filesystem::path& file);

}  // namespace vobench
