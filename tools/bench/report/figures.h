// Figures of a run's report.
// Source: docs/report.md.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/bench/report/figure.h"
#include "tools/bench/result/result.h"

namespace vobench::report {

// Paths in space with the permanent landmarks of the final maps, from above and from the side. In the truth's world
// where there is one, aligned by Sim(3). "Above" is the world axis nearest to where the images' upper edges point.
std::vector<Figure> PathFigures(const ResultData& data);
// Position and orientation in time, of each system's typical run.
std::vector<Figure> PoseFigures(const ResultData& data);
// Distance from the truth in time, aligned by Sim(3).
std::vector<Figure> AlignedErrorFigures(const ResultData& data);
// Errors with the three sigma that the filters claim, not aligned; each system's typical run. Pose, or velocity.
std::vector<Figure> PoseErrorFigures(const ResultData& data);
std::vector<Figure> VelocityErrorFigures(const ResultData& data);
// NEES over runs, with bands.
std::vector<Figure> NeesFigures(const ResultData& data);
std::vector<Figure> NisFigures(const ResultData& data);
// Ranks of the truth among draws of the filter, over runs; the last of the frames that were ranked.
std::vector<Figure> RankFigures(const ResultData& data);
// Features and matches, landmarks, time by stage; frame by frame.
std::vector<Figure> FrameFigures(const ResultData& data);

}  // namespace vobench::report
