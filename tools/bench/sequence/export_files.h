// Output formats of `vobench export`: ROS 1 bags, MCAP with the messages of ROS 2, COCO's file of instances.
// Source: ROS bag format 2.0; MCAP format 0 (mcap.dev/spec); sensor_msgs, geometry_msgs; CDR (OMG DDS-RTPS 2.2);
//   REP 103, 104, 118; COCO data format (cocodataset.org/#format-data).
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/files.h"
#include "tools/judge/evaluation/trajectory.h"
#include "vo/geometry/camera.h"

namespace vobench {

static_assert(std::endian::native == std::endian::little, "numbers are written as the machine has them");

template <class T>
std::string Bytes(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
// With its length before it.
inline std::string Sized(std::string_view text) { return Bytes(static_cast<std::uint32_t>(text.size())).append(text); }

struct RosType {
  const char *package, *name, *md5, *definition, *definition2;  // definition2: of ROS 2
};

// A recording of messages. The file appears with Close. Messages are added in order of time. Throws
// std::runtime_error naming the file.
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
  void Add(const std::string& topic, const RosType& type, std::int64_t stamp_ns, const std::string& message);

  bool ros2_;
  Chunk chunk_;
};

// Stamps at least 1 ns: a bag has no time 0.
std::unique_ptr<MessageFile> MakeBag(const std::filesystem::path& file);
std::unique_ptr<MessageFile> MakeMcap(const std::filesystem::path& file);

// The text of COCO's file of object detection: boxes [x, y, width, height], masks as run lengths down the columns. Each
// frame is an image, each instance that is seen in it an annotation; ids are those of labels.json. Throws
// std::runtime_error where the sequence has no instances, or a file is unreadable.
std::string CocoJson(const std::filesystem::path& sequence);

}  // namespace vobench
