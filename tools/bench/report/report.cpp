#include "tools/bench/report/report.h"

#include "tools/bench/report/page.h"
#include "tools/bench/report/result_data.h"
#include "tools/judge/evaluation/whole_file.h"

namespace report {

void WriteReport(const std::filesystem::path& out) {
  evaluation::WriteWhole(out / "report.html", Html(RunPage(out, ReadResult(out))));
}

}  // namespace report
