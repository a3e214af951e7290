#include "tools/bench/report/report.h"

#include <fmt/format.h>

#include <stdexcept>

#include "tools/bench/errors.h"
#include "tools/bench/result/run_json.h"
#include "tools/bench/run/commands.h"

namespace vobench {

void Report(const ReportOptions& options) {
  // Read here first, so that what is wrong with the folder is told from a report that cannot be written.
  Input([&] { return ReadRunJson(options.output); });
  try {
    report::WriteReport(options.output);
  } catch (const std::invalid_argument& error) {
    throw BadInput(error.what());
  }
  fmt::print("{}\n", (options.output / "report.html").string());
}

}  // namespace vobench
