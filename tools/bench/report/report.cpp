#include "tools/bench/report/report.h"

#include "tools/base/files.h"
#include "tools/bench/report/page.h"

namespace vobench::report {

void WriteReport(const std::filesystem::path& out, const ResultData& data) {
  base::WriteFile(out / "report.html", Html(RunPage(out, data)));
}

void WriteReport(const std::filesystem::path& out) { WriteReport(out, ReadResult(out)); }

}  // namespace vobench::report
