#include "tools/bench/report/report.h"

#include "tools/bench/report/page.h"
#include "tools/judge/evaluation/whole_file.h"

namespace vobench::report {

void WriteReport(const std::filesystem::path& out, const ResultData& data) {
  evaluation::WriteWhole(out / "report.html", Html(RunPage(out, data)));
}

void WriteReport(const std::filesystem::path& out) { WriteReport(out, ReadResult(out)); }

}  // namespace vobench::report
