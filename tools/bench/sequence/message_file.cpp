#include "tools/bench/sequence/message_file.h"

#include <algorithm>
#include <utility>

#include "tools/bench/sequence/ros_definitions.h"
#include "tools/bench/sequence/ros_message.h"

namespace vobench {
namespace {

constexpr std::size_t kChunkBytes = 1 << 22;

constexpr RosType kImage = {"sensor_msgs/Image", "sensor_msgs/msg/Image", "060021388200f6f0f447d0fcd9c64743", kImage1,
                            kImage2};
constexpr RosType kInfo = {"sensor_msgs/CameraInfo", "sensor_msgs/msg/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
                           kCameraInfo1, kCameraInfo2};
constexpr RosType kImu = {"sensor_msgs/Imu", "sensor_msgs/msg/Imu", "6a62c6daae103f4ff57a132d6f95cec2", kImu1, kImu2};
constexpr RosType kPose = {"geometry_msgs/PoseStamped", "geometry_msgs/msg/PoseStamped",
                           "d3812c3cbc69362b77dc0b19b345f8f5", kPoseStamped1, kPoseStamped2};

std::uint32_t Whole(std::size_t number) { return static_cast<std::uint32_t>(number); }

}  // namespace

void MessageFile::Image(const std::string& topic, const std::string& frame, std::int64_t stamp_ns, const cv::Mat& image,
                        const char* encoding) {
  RosMessage m(ros2_, stamp_ns, frame);
  m.Put(Whole(static_cast<std::size_t>(image.rows)));
  m.Put(Whole(static_cast<std::size_t>(image.cols)));
  m.Put(std::string(encoding));
  m.Put(std::uint8_t{0});  // little-endian
  const std::size_t step = static_cast<std::size_t>(image.cols) * image.elemSize();
  m.Put(Whole(step));
  m.PutBytes(std::string_view(reinterpret_cast<const char*>(image.data), step * static_cast<std::size_t>(image.rows)));
  Add(topic, kImage, stamp_ns, m);
}

void MessageFile::CameraInfo(const std::string& topic, const std::string& frame, std::int64_t stamp_ns,
                             const vo::Camera& c) {
  const bool fisheye = c.lens == vo::Lens::fisheye;
  RosMessage m(ros2_, stamp_ns, frame);
  m.Put(Whole(static_cast<std::size_t>(c.height)));
  m.Put(Whole(static_cast<std::size_t>(c.width)));
  m.Put(std::string(fisheye ? "equidistant" : "plumb_bob"));
  m.Put(std::uint32_t{fisheye ? 4U : 5U});
  fisheye ? m.Put({c.k1, c.k2, c.k3, c.k4}) : m.Put({c.k1, c.k2, c.p1, c.p2, c.k3});
  m.Put({c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1});
  m.Put({1, 0, 0, 0, 1, 0, 0, 0, 1});
  m.Put({c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0});
  for (int binning_and_region = 0; binning_and_region < 6; ++binning_and_region) m.Put(std::uint32_t{0});
  m.Put(std::uint8_t{0});
  Add(topic, kInfo, stamp_ns, m);
}

void MessageFile::Imu(const std::string& topic, std::int64_t stamp_ns, const Eigen::Vector3d& w,
                      const Eigen::Vector3d& f) {
  RosMessage m(ros2_, stamp_ns, "imu");
  m.Put({0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0});  // no orientation: its covariance begins with -1
  m.Put({w.x(), w.y(), w.z(), 0, 0, 0, 0, 0, 0, 0, 0, 0});
  m.Put({f.x(), f.y(), f.z(), 0, 0, 0, 0, 0, 0, 0, 0, 0});
  Add(topic, kImu, stamp_ns, m);
}

void MessageFile::Pose(const std::string& topic, std::int64_t stamp_ns, const evaluation::StampedPose& T_WC) {
  RosMessage m(ros2_, stamp_ns, "world");
  m.Put({T_WC.p_WC.x(), T_WC.p_WC.y(), T_WC.p_WC.z()});
  m.Put({T_WC.q_WC.x(), T_WC.q_WC.y(), T_WC.q_WC.z(), T_WC.q_WC.w()});
  Add(topic, kPose, stamp_ns, m);
}

void MessageFile::Append(const std::string& bytes) {
  file_.Append(bytes);
  position_ += bytes.size();
}

void MessageFile::Add(const std::string& topic, const RosType& type, std::int64_t stamp_ns, const RosMessage& message) {
  auto at = std::ranges::find(channels_, topic, &Channel::topic);
  const auto channel = static_cast<std::uint32_t>(at - channels_.begin());
  if (at == channels_.end()) {
    channels_.push_back({topic, &type});
    chunk_.records += ConnectionRecord(channel);
  }
  ++channels_[channel].count;
  if (chunk_.index.empty()) chunk_.first_ns = stamp_ns;
  chunk_.last_ns = stamp_ns;
  chunk_.index[channel].push_back({stamp_ns, chunk_.records.size()});
  chunk_.records += MessageRecord(channel, stamp_ns, message.bytes());
  if (chunk_.records.size() > kChunkBytes) Write(std::exchange(chunk_, {}));
}

void MessageFile::Close() {
  if (!chunk_.index.empty()) Write(chunk_);
  WriteEnd();
  file_.Commit();
}

}  // namespace vobench
