#include "tools/bench/campaign/opencv_yaml.h"

#include <sstream>
#include <stdexcept>

#include "tools/judge/evaluation/text_file.h"

namespace campaign {

OpenCvYaml::OpenCvYaml(const std::string& text) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#' || line == "---" || line.starts_with("%YAML")) continue;
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) throw std::invalid_argument("not 'key: value': " + line);
    std::string value = line.substr(colon + 2);
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
    values_[line.substr(0, colon)] = value;
  }
}

const std::string& OpenCvYaml::Text(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) throw std::invalid_argument("no key " + key);
  return found->second;
}

double OpenCvYaml::Number(const std::string& key) const {
  const std::optional<double> value = evaluation::ParseNumber(Text(key));
  if (!value) throw std::invalid_argument(key + ": not a number: " + Text(key));
  return *value;
}

}  // namespace campaign
