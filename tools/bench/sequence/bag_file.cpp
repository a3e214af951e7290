#include "tools/bench/sequence/bag_file.h"

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace vobench {
namespace {

ros::Time TimeOf(std::int64_t stamp_ns) {
  return {static_cast<std::uint32_t>(stamp_ns / 1000000000), static_cast<std::uint32_t>(stamp_ns % 1000000000)};
}

template <class Message>
Message Stamped(std::int64_t stamp_ns, const char* frame) {
  Message message;
  message.header.stamp = TimeOf(stamp_ns);
  message.header.frame_id = frame;
  return message;
}

template <class From, class To>
void Set(const From& from, To& to) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

// Rosbag says that a write failed, not why: the system does.
template <class Work>
void Written(const std::string& file, Work&& work) {
  errno = 0;
  try {
    work();
  } catch (const std::exception& error) {
    const int why = errno;
    throw std::runtime_error(file + ": cannot be written: " + error.what() +
                             (why != 0 ? ": " + std::generic_category().message(why) : ""));
  }
}

}  // namespace

struct BagFile::Impl {
  std::string name;  // in errors
  std::unique_ptr<rosbag::Bag> bag = std::make_unique<rosbag::Bag>();

  explicit Impl(std::string shown) : name(std::move(shown)) {}
  ~Impl() {
    try {
      Close();
    } catch (const std::exception&) {
    }
  }

  // A bag whose close failed is given up, not destroyed: it would close its file once more, and throw.
  void Close() {
    try {
      if (bag) bag->close();
    } catch (const std::exception&) {
      static_cast<void>(bag.release());
      throw;
    }
  }

  template <class Message>
  void Write(const std::string& topic, std::int64_t stamp_ns, const Message& message) {
    Written(name, [&] { bag->write(topic, TimeOf(stamp_ns), message); });
  }
};

BagFile::BagFile(const std::string& file, const std::string& name) : impl_(std::make_unique<Impl>(name)) {
  Written(name, [&] { impl_->bag->open(file, rosbag::bagmode::Write); });
}

BagFile::~BagFile() = default;

void BagFile::Image(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& image, const char* encoding) {
  auto message = Stamped<sensor_msgs::Image>(stamp_ns, "camera");
  message.width = static_cast<std::uint32_t>(image.cols);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.encoding = encoding;
  message.step = message.width * static_cast<std::uint32_t>(image.elemSize());
  message.data.assign(image.data, image.data + std::size_t{message.step} * message.height);
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::CameraInfo(const std::string& topic, std::int64_t stamp_ns, const vo::Camera& c) {
  const bool fisheye = c.lens == vo::Lens::fisheye;
  auto message = Stamped<sensor_msgs::CameraInfo>(stamp_ns, "camera");
  message.width = static_cast<std::uint32_t>(c.width);
  message.height = static_cast<std::uint32_t>(c.height);
  message.distortion_model = fisheye ? "equidistant" : "plumb_bob";
  message.D = fisheye ? std::vector{c.k1, c.k2, c.k3, c.k4} : std::vector{c.k1, c.k2, c.p1, c.p2, c.k3};
  message.K = {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0};
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Imu(const std::string& topic, std::int64_t stamp_ns, const Eigen::Vector3d& angular_rate,
                  const Eigen::Vector3d& specific_force) {
  auto message = Stamped<sensor_msgs::Imu>(stamp_ns, "imu");
  message.orientation_covariance[0] = -1;  // no orientation in it
  Set(angular_rate, message.angular_velocity);
  Set(specific_force, message.linear_acceleration);
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Pose(const std::string& topic, std::int64_t stamp_ns, const evaluation::StampedPose& T_WC) {
  auto message = Stamped<geometry_msgs::PoseStamped>(stamp_ns, "world");
  Set(T_WC.p_WC, message.pose.position);
  Set(T_WC.q_WC, message.pose.orientation);
  message.pose.orientation.w = T_WC.q_WC.w();
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Close() {
  Written(impl_->name, [&] { impl_->Close(); });
}

}  // namespace vobench
