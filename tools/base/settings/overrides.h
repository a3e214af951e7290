// Settings given beside a file, --set KEY=VALUE: (dotted key, YAML value), a later one wins.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace settings {

using Overrides = std::vector<std::pair<std::string, std::string>>;

}  // namespace settings
