// Purpose: what runs on images and runs on points have in common.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/bench/report/run_json.h"
#include "tools/bench/result/output_folder.h"
#include "tools/bench/result/result.h"
#include "tools/bench/systems/experiment.h"
#include "tools/judge/evaluation/summary.h"
#include "tools/vobench/commands.h"

namespace vobench {

using Folder = std::unique_ptr<OutputFolder>;  // none: nothing is kept

Folder MakeFolder(const RunOptions& options);

// All of run.json but the runs.
report::RunDescription Describe(const RunOptions& options, const Experiment& experiment,
                                const std::vector<std::string>& notes, const Clock& clock);

// Each run has a world of points of its own, seeded like its filter. Called by Run.
void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock);

}  // namespace vobench
