// Page of a run: sections of report.html and of the live view.
#pragma once

#include <filesystem>

#include "tools/bench/report/html.h"
#include "tools/bench/result/result.h"

namespace vobench::report {

// `out` is the result folder, for its pictures. Throws evaluation::InputError where one cannot be read.
Page RunPage(const std::filesystem::path& out, const ResultData& data);

// Of runs that are not done yet: words, figures and their newest frame.
Page LivePage(const ResultData& data, FrameViewer newest);

}  // namespace vobench::report
