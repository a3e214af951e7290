#include "tools/bench/sequence/bag_file.h"

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include <cerrno>
#include <map>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

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

void BagFile::Image(const std::string& topic, std::int64_t stamp_ns, const Picture& picture) {
  auto message = Stamped<sensor_msgs::Image>(stamp_ns, "camera");
  message.width = picture.width;
  message.height = picture.height;
  message.encoding = picture.encoding;
  message.step = picture.width * picture.bytes_per_pixel;
  message.data.assign(picture.data, picture.data + std::size_t{message.step} * picture.height);
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::CameraInfo(const std::string& topic, std::int64_t stamp_ns, const Lens& lens) {
  auto message = Stamped<sensor_msgs::CameraInfo>(stamp_ns, "camera");
  message.width = lens.width;
  message.height = lens.height;
  message.distortion_model = lens.model;
  message.D = lens.coefficients;
  message.K = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {lens.fx, 0, lens.cx, 0, 0, lens.fy, lens.cy, 0, 0, 0, 1, 0};
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Imu(const std::string& topic, std::int64_t stamp_ns, const std::array<double, 3>& angular_rate,
                  const std::array<double, 3>& specific_force) {
  auto message = Stamped<sensor_msgs::Imu>(stamp_ns, "imu");
  message.orientation_covariance[0] = -1;  // no orientation in it
  message.angular_velocity.x = angular_rate[0];
  message.angular_velocity.y = angular_rate[1];
  message.angular_velocity.z = angular_rate[2];
  message.linear_acceleration.x = specific_force[0];
  message.linear_acceleration.y = specific_force[1];
  message.linear_acceleration.z = specific_force[2];
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Pose(const std::string& topic, std::int64_t stamp_ns, const std::array<double, 3>& p,
                   const std::array<double, 4>& q) {
  auto message = Stamped<geometry_msgs::PoseStamped>(stamp_ns, "world");
  message.pose.position.x = p[0];
  message.pose.position.y = p[1];
  message.pose.position.z = p[2];
  message.pose.orientation.x = q[0];
  message.pose.orientation.y = q[1];
  message.pose.orientation.z = q[2];
  message.pose.orientation.w = q[3];
  impl_->Write(topic, stamp_ns, message);
}

void BagFile::Close() {
  Written(impl_->name, [&] { impl_->Close(); });
}

std::vector<std::string> BagFile::Topics(const std::string& file) {
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  std::map<std::string, std::size_t> counts;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    ++counts[message.getTopic() + " " + message.getDataType()];
  }
  std::vector<std::string> topics;
  for (const auto& [topic, count] : counts) topics.push_back(topic + " " + std::to_string(count));
  return topics;
}

}  // namespace vobench
