// Purpose: report.html as text: words, tables, diagrams and pictures in one self-contained page.
#pragma once

#include <string>

#include "tools/report/result_data.h"

namespace report {

// No scripts, nothing loaded from elsewhere. Pictures are embedded until they fill 1.4 MB, evenly over the sequence.
std::string Page(const ResultData& data);

}  // namespace report
