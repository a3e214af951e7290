#include "tests/system/bag_topics.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <map>

namespace vobench::system_test {

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

}  // namespace vobench::system_test
