#include "tools/bench/result/time_table.h"

#include <algorithm>

#include "tools/bench/text.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench {

std::string TimeTable(const std::vector<evaluation::FrameRecord>& frames, double elapsed_s) {
  if (frames.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"Time per frame [ms]", "median", "95 %", "longest"}};
  const auto add = [&](const std::string& name, const auto& time_of) {
    std::vector<double> times;
    for (const evaluation::FrameRecord& frame : frames) times.push_back(time_of(frame));
    std::sort(times.begin(), times.end());
    rows.push_back({name, Fixed(evaluation::Quantile(times, 0.5), 2), Fixed(evaluation::Quantile(times, 0.95), 2),
                    Fixed(times.back(), 2)});
  };
  using Record = evaluation::FrameRecord;
  add("features", [](const Record& f) { return f.ms_features; });
  add("matching", [](const Record& f) { return f.ms_matching; });
  add("filter", [](const Record& f) { return f.ms_filter; });
  add("all", [](const Record& f) { return f.ms_features + f.ms_matching + f.ms_filter; });
  const double n = static_cast<double>(frames.size());
  return AlignedTable(rows) + std::to_string(frames.size()) + " frames in " + Fixed(elapsed_s, 2) +
         " s, read and tracked: " + Fixed(1e3 * elapsed_s / n, 2) + " ms each, " + Fixed(n / elapsed_s, 1) +
         " a second.\n";
}

}  // namespace vobench
