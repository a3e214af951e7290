// The command line, parsed into the options of one sub-command.
#pragma once

#include <string>
#include <variant>

#include "tools/bench/campaign/options.h"
#include "tools/bench/run/commands.h"

namespace vobench {

using Command = std::variant<RenderOptions, TrackOptions, EvaluateOptions, RunOptions, CheckOptions, ReportOptions,
                             VerifyOptions, CampaignOptions, BenchOptions, ExportOptions, SettingsOptions,
                             FitCameraOptions, ImportOptions, LookOptions>;

// The command, or the exit status where there is none to run: 0 after --help and --version, 2 for an invalid command
// line (the reason is on stderr). Throws BadInput for an invalid --compat.
std::variant<Command, int> ParseArguments(int argc, char** argv);

// --compat of `vobench evaluate`: the other tool and its own options (docs/metrics.md, "Other tools' numbers"). "tum",
// "tum ate --verbose", "evo rpe --delta 10 --all_pairs", ...: throws BadInput listing the valid choices.
Reproduction ParseCompat(const std::string& request);

}  // namespace vobench
