// Style and script of the page, embedded by the build from tools/bench/report/web/.
#pragma once

#include <string>

namespace vobench::report {

const std::string& Style();
const std::string& Script();

}  // namespace vobench::report
