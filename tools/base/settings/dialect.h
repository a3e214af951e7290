// Dialects of YAML.
#pragma once

namespace settings {

enum class Dialect {
  ours,
  opencv,  // as cv::FileStorage writes it: the first line, "%YAML:1.0", is none of YAML's, and matrices have tags
};

}  // namespace settings
