#include "tools/bench/report/report.h"

#include "tools/base/files.h"
#include "tools/bench/report/page.h"
#include "tools/bench/report/result_data.h"

namespace report {

void WriteReport(const std::filesystem::path& out) {
  base::WriteFile(out / "report.html", Html(RunPage(out, ReadResult(out))));
}

}  // namespace report
