// Purpose: the diagrams of the report, each as HTML ready to stand in a grid of panels.
// Source:  docs/report.md says what each shows.
#pragma once

#include <cstddef>
#include <string>

#include "tools/report/result_data.h"

namespace report {

// The class ("s0" ... "s4") that gives a system its colour and dash.
std::string StyleOf(std::size_t system);

// Paths from above, with landmarks, and from the side. In the truth's world where there is one, aligned by Sim(3).
std::string PathFigures(const ResultData& data);
// Position and orientation in time, of each system's typical run.
std::string PoseFigures(const ResultData& data);
// Distance from the truth in time, aligned by Sim(3).
std::string AlignedErrorFigures(const ResultData& data);
// Errors with the three sigma that the filter claims, not aligned; one system's typical run. Pose, or velocity.
std::string PoseErrorFigures(const RunData& run, std::size_t system);
std::string VelocityErrorFigures(const RunData& run, std::size_t system);
// NEES over runs, with bands.
std::string NeesFigures(const ResultData& data);
std::string NisFigures(const ResultData& data);
std::string FeatureFigures(const ResultData& data);

}  // namespace report
