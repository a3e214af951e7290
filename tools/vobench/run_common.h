// Purpose: what runs on images and runs on points have in common.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/evaluation/summary.h"
#include "tools/report/run_json.h"
#include "tools/vobench/commands.h"
#include "tools/vobench/experiment.h"
#include "tools/vobench/output_folder.h"
#include "tools/vobench/result.h"

namespace vobench {

using Folder = std::unique_ptr<OutputFolder>;  // none: nothing is kept

Folder MakeFolder(const RunOptions& options);

// Whose world the errors are taken in, as the prior has it.
evaluation::JudgeOptions JudgeOptionsOf(const PriorSettings& prior);

// All of run.json but the runs.
report::RunDescription Describe(const RunOptions& options, const Experiment& experiment,
                                const std::vector<std::string>& notes, const Clock& clock);

// Each run has a world of points of its own, seeded like its filter. Called by Run.
void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock);

}  // namespace vobench
