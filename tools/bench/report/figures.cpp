#include "tools/bench/report/figures.h"

#include <algorithm>

namespace vobench::report {

namespace ev = evaluation;

std::vector<const RunData*> FaintRuns(const ResultData& data, const std::string& system) {
  std::vector<const RunData*> others = data.RunsOf(system);
  std::erase(others, &data.Typical(system));
  if (others.size() <= kFaintRuns) return others;
  SortByAte(others);
  std::vector<const RunData*> kept;
  for (std::size_t k = 0; k < kFaintRuns; ++k) kept.push_back(others[k * (others.size() - 1) / (kFaintRuns - 1)]);
  return kept;
}

const RunData* AnyJudged(const ResultData& data) {
  const auto found = std::find_if(data.runs.begin(), data.runs.end(), [](const RunData& run) { return run.judged; });
  return found == data.runs.end() ? nullptr : &*found;
}

const ev::Trajectory& Reference(const ResultData& data) {
  const RunData& shown = data.Typical(data.Systems().front());
  if (shown.judged) return shown.judged->truth;
  const RunData* judged = AnyJudged(data);
  return judged ? judged->judged->truth : data.runs.front().run.trajectory;
}

double Seconds(const ResultData& data, std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - data.runs.front().run.trajectory.front().stamp_ns) * 1e-9;
}

Numbers Times(const ResultData& data, const ev::Trajectory& trajectory) {
  Numbers times;
  for (const ev::StampedPose& pose : trajectory) times.push_back(Seconds(data, pose.stamp_ns));
  return times;
}

const ev::Trajectory& Drawn(const RunData& run) { return run.judged ? run.judged->aligned : run.run.trajectory; }

Figure InTime(const std::string& title, const std::string& description, const Axis& y) {
  Figure figure;
  figure.title = title;
  figure.description = description;
  figure.x.label = "time [s]";
  figure.y = y;
  return figure;
}

}  // namespace vobench::report
