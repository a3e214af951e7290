// Purpose: the flat `key: value` files of OpenCV's FileStorage and of ROS parameters, as far as calibrations use them.
#pragma once

#include <map>
#include <string>

namespace campaign {

class OpenCvYaml {
 public:
  // Lines that are empty, a comment, "%YAML:1.0" or "---" say nothing. Throws std::invalid_argument for any other that
  // is not `key: value`.
  explicit OpenCvYaml(const std::string& text);

  bool Has(const std::string& key) const { return values_.contains(key); }
  // Throw std::invalid_argument where there is no such key, or no number.
  const std::string& Text(const std::string& key) const;
  double Number(const std::string& key) const;

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace campaign
