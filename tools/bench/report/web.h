// Purpose: the page's style and script: the files of tools/bench/report/web/, embedded by the build.
#pragma once

#include <string>

namespace report {

const std::string& Style();
const std::string& Script();

}  // namespace report
