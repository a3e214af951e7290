#include "tools/report/report.h"

#include "tools/evaluation/whole_file.h"
#include "tools/report/page.h"
#include "tools/report/result_data.h"

namespace report {

void WriteReport(const std::filesystem::path& out) {
  evaluation::WriteWhole(out / "report.html", Html(RunPage(out, ReadResult(out))));
}

}  // namespace report
