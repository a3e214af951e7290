// Topics of a ROS 1 bag, read by rosbag. Compiled as C++17: rosbag's headers are not C++20.
#pragma once

#include <string>
#include <vector>

namespace vobench::system_test {

// Message counts by topic, "TOPIC TYPE COUNT" each.
std::vector<std::string> BagTopics(const std::string& file);

// Each message, in order of time: "SECONDS TOPIC CONTENT", the content by ROS's own types.
std::vector<std::string> BagMessages(const std::string& file);

}  // namespace vobench::system_test
