#include "tests/system/bag_topics.h"

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include <cstdio>
#include <cstring>
#include <map>

namespace vobench::system_test {
namespace {

template <class... Values>
std::string Text(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Text of a message as read by rosbag, which refuses a type with another MD5 sum.
std::string TextOf(const rosbag::MessageInstance& message) {
  if (const auto image = message.instantiate<sensor_msgs::Image>()) {
    float first = 0;
    if (image->encoding == "32FC1") std::memcpy(&first, image->data.data(), sizeof first);
    return Text("%u %u %s %u %zu %.4f", image->width, image->height, image->encoding.c_str(), image->step,
                image->data.size(), static_cast<double>(first));
  }
  if (const auto info = message.instantiate<sensor_msgs::CameraInfo>())
    return Text("%u %u %s %zu %g %g %g %g", info->width, info->height, info->distortion_model.c_str(), info->D.size(),
                info->K[0], info->K[2], info->K[5], info->P[10]);
  if (const auto imu = message.instantiate<sensor_msgs::Imu>())
    return Text("%.12f %.12f %g", imu->angular_velocity.x, imu->linear_acceleration.z, imu->orientation_covariance[0]);
  const auto pose = message.instantiate<geometry_msgs::PoseStamped>();
  return pose ? Text("%.12f %.12f", pose->pose.position.x, pose->pose.orientation.w) : "?";
}

}  // namespace

std::vector<std::string> BagTopics(const std::string& file) {
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  std::map<std::string, std::size_t> counts;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    ++counts[message.getTopic() + " " + message.getDataType()];
  }
  std::vector<std::string> topics;
  for (const auto& [topic, count] : counts) topics.push_back(topic + " " + std::to_string(count));
  return topics;
}

std::vector<std::string> BagMessages(const std::string& file) {
  rosbag::Bag bag(file, rosbag::bagmode::Read);
  std::vector<std::string> texts;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const ros::Time time = message.getTime();
    texts.push_back(Text("%u.%09u ", time.sec, time.nsec) + message.getTopic() + " " + TextOf(message));
  }
  return texts;
}

}  // namespace vobench::system_test
