// Topics of a ROS 1 bag as the library reads them back. Compiled as C++17: rosbag's headers are not C++20.
#pragma once

#include <string>
#include <vector>

namespace vobench::system_test {

// Message counts by topic, "TOPIC TYPE COUNT" each.
std::vector<std::string> BagTopics(const std::string& file);

}  // namespace vobench::system_test
