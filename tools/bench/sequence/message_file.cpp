#include <algorithm>
#include <concepts>
#include <utility>

#include "tools/bench/sequence/export_files.h"
#include "tools/bench/sequence/ros_definitions.h"

namespace vobench {
namespace {

constexpr std::size_t kChunkBytes = 1 << 22;

constexpr RosType kImage = {"sensor_msgs", "Image", "060021388200f6f0f447d0fcd9c64743", kImage1, kImage2};
constexpr RosType kInfo = {"sensor_msgs", "CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214", kCameraInfo1, kCameraInfo2};
constexpr RosType kImu = {"sensor_msgs", "Imu", "6a62c6daae103f4ff57a132d6f95cec2", kImu1, kImu2};
constexpr RosType kPose = {"geometry_msgs", "PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5", kPoseStamped1,
                           kPoseStamped2};

// Packed (ROS 1), or CDR, aligned and with a head of four bytes (ROS 2).
class RosMessage {
 public:
  RosMessage(bool ros2, const std::string& frame, std::int64_t stamp_ns)
      : bytes(ros2 ? std::string("\0\1\0\0", 4) : Bytes(std::uint32_t{0})), ros2_(ros2) {  // ROS 1 has a number here
    Put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000), static_cast<std::uint32_t>(stamp_ns % 1'000'000'000),
        frame);
  }

  void Put(const auto&... values) { (PutOne(values), ...); }
  void PutData(std::string_view data) {
    Put(static_cast<std::uint32_t>(data.size()));
    bytes += data;
  }
  void PutNumbers(std::initializer_list<double> numbers) {
    for (const double number : numbers) Put(number);
  }

  std::string bytes;

 private:
  template <class T>
  void PutOne(const T& value) {
    if constexpr (std::convertible_to<T, std::string>) {
      const std::string text(value);
      PutData(ros2_ ? std::string_view(text.c_str(), text.size() + 1) : text);
    } else {
      while (ros2_ && (bytes.size() - 4) % sizeof(T) != 0) bytes += '\0';
      bytes += Bytes(value);
    }
  }
  bool ros2_;
};

std::string FrameOf(const std::string& topic) { return topic.substr(1, topic.find('/', 1) - 1); }

}  // namespace

void MessageFile::Image(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& image, const char* encoding) {
  RosMessage m(ros2_, FrameOf(topic), stamp_ns);
  const std::size_t step = static_cast<std::size_t>(image.cols) * image.elemSize();
  m.Put(image.rows, image.cols, encoding, std::uint8_t{0}, static_cast<std::uint32_t>(step));  // 0: little-endian
  m.PutData({reinterpret_cast<const char*>(image.data), step * static_cast<std::size_t>(image.rows)});
  Add(topic, kImage, stamp_ns, m.bytes);
}

void MessageFile::CameraInfo(const std::string& topic, std::int64_t stamp_ns, const vo::Camera& c) {
  const bool fisheye = c.lens == vo::Lens::fisheye;
  RosMessage m(ros2_, FrameOf(topic), stamp_ns);
  m.Put(c.height, c.width, fisheye ? "equidistant" : "plumb_bob", std::uint32_t{fisheye ? 4U : 5U});
  m.Put(c.k1, c.k2, fisheye ? c.k3 : c.p1, fisheye ? c.k4 : c.p2);
  if (!fisheye) m.Put(c.k3);
  m.PutNumbers({c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1});
  m.PutNumbers({1, 0, 0, 0, 1, 0, 0, 0, 1});
  m.PutNumbers({c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0});
  m.Put(0, 0, 0, 0, 0, 0, std::uint8_t{0});  // binning, region
  Add(topic, kInfo, stamp_ns, m.bytes);
}

void MessageFile::Imu(const std::string& topic, std::int64_t stamp_ns, const std::vector<double>& x) {
  RosMessage m(ros2_, "imu", stamp_ns);
  m.PutNumbers({0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0});  // no orientation: its covariance begins with -1
  m.PutNumbers({x[0], x[1], x[2], 0, 0, 0, 0, 0, 0, 0, 0, 0});
  m.PutNumbers({x[3], x[4], x[5], 0, 0, 0, 0, 0, 0, 0, 0, 0});
  Add(topic, kImu, stamp_ns, m.bytes);
}

void MessageFile::Pose(const std::string& topic, std::int64_t stamp_ns, const evaluation::StampedPose& T_WC) {
  RosMessage m(ros2_, "world", stamp_ns);
  const auto& [p, q] = std::pair(T_WC.p_WC, T_WC.q_WC);
  m.Put(p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  Add(topic, kPose, stamp_ns, m.bytes);
}

void MessageFile::Append(const std::string& bytes) {
  file_.Append(bytes);
  position_ += bytes.size();
}

void MessageFile::Add(const std::string& topic, const RosType& type, std::int64_t stamp_ns,
                      const std::string& message) {
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
  chunk_.records += MessageRecord(channel, stamp_ns, message);
  if (chunk_.records.size() > kChunkBytes) Write(std::exchange(chunk_, {}));
}

void MessageFile::Close() {
  if (!chunk_.index.empty()) Write(chunk_);
  WriteEnd();
  file_.Commit();
}

}  // namespace vobench
