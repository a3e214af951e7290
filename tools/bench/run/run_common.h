// Description and result folder of a run, of images and of points.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/simulator.h"
#include "tools/bench/provenance.h"
#include "tools/bench/result/output_folder.h"
#include "tools/bench/result/result.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/systems/experiment.h"

namespace vobench {

using Folder = std::unique_ptr<OutputFolder>;  // none: nothing is kept

Folder MakeFolder(const RunOptions& options);

// Simulator with its world loaded and baked. A signal that HoldInterrupts blocks ends the program meanwhile, with exit
// status 1: there is nothing to keep yet. Throws BadInput.
sim::Simulator LoadSimulator(const sim::Scenario& scenario, int jobs);

// Description for run.json, without its runs.
RunDescription Describe(const RunOptions& options, const Experiment& experiment, const std::vector<std::string>& notes,
                        const Clock& clock);

// Writes the files at the top of the folder and report.html, and gives the folder its name. Throws std::runtime_error.
void Conclude(OutputFolder& folder, ResultData& result);

// task(i) for i = 0 ... count - 1 on `jobs` threads. Items share nothing: results do not depend on that number. Throws
// the first exception of a task.
void ForEach(std::size_t count, int jobs, const std::function<void(std::size_t)>& task);

// A preset or a file; or else the sequence's own camera.yaml, or EuRoC's sensor.yaml. Throws BadInput, settings::Error,
// std::invalid_argument.
vo::Camera CameraOfSequence(const std::filesystem::path& sequence, const std::optional<std::string>& camera);
// Camera and settings of a tracked sequence, as JSON.
std::string RecordOfTracking(const vo::Camera& camera, const std::string& settings);

// Why too few poses have a true one to determine an alignment; empty: there are three or more.
std::string AlignmentProblem(const evaluation::Metrics& metrics);

// Runs on worlds of points: each run has its own, seeded like its filter. Called by Run.
void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock);

}  // namespace vobench
