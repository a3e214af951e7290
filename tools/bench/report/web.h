// Purpose: what tools/bench/report/web/ became in the build: the page's style and, unless VOBENCH_REPORT_SCRIPTS is off, its
//          script with the licences of what it contains.
#pragma once

#include <string>

namespace report {

const std::string& Style();
const std::string& Script();  // empty without
bool HasScript();

}  // namespace report
