// Figures of a run's report; and shared steps: selection of the drawn runs, and their time axis.
// Source: docs/report.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/report/figure.h"
#include "tools/bench/result/result.h"

namespace vobench::report {

// Paths in space with the permanent landmarks of the final maps, from above and from the side. In the truth's world
// where there is one, aligned by Sim(3). "Above" is the world axis nearest to where the images' upper edges point.
std::vector<Figure> PathFigures(const ResultData& data);
// Distance from the truth in time, aligned by Sim(3).
std::vector<Figure> AlignedErrorFigures(const ResultData& data);
// Errors with the filters' three-sigma bounds, not aligned; each system's typical run. Pose, or velocity.
std::vector<Figure> PoseErrorFigures(const ResultData& data);
std::vector<Figure> VelocityErrorFigures(const ResultData& data);
// NEES over runs, with bands.
std::vector<Figure> NeesFigures(const ResultData& data);
std::vector<Figure> NisFigures(const ResultData& data);
// Ranks of the truth among draws of the filter, over runs; at the last ranked frame.
std::vector<Figure> RankFigures(const ResultData& data);
// Features and matches, landmarks, time by stage; frame by frame.
std::vector<Figure> FrameFigures(const ResultData& data);

constexpr double kCentimetres = 100;

// A system's other runs beside the typical one are drawn faint: these, from the best to the worst, both among them.
constexpr std::size_t kFaintRuns = 9;
std::vector<const RunData*> FaintRuns(const ResultData& data, const std::string& system);

// None where no run is evaluated.
const RunData* AnyJudged(const ResultData& data);

// The path that the drawn runs belong to: the truth, or where there is none the first run's own.
const evaluation::Trajectory& Reference(const ResultData& data);

// Time zero of every figure: the first pose of the first run.
double Seconds(const ResultData& data, std::int64_t stamp_ns);
Numbers Times(const ResultData& data, const evaluation::Trajectory& trajectory);

// The trajectory that stands for a run: aligned where there is a truth.
const evaluation::Trajectory& Drawn(const RunData& run);

// A figure along that time, without series.
Figure InTime(const std::string& title, const std::string& description, const Axis& y);

}  // namespace vobench::report
