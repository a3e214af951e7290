// Sequences of a campaign in the cache: name by content, rendering; recorded ones, read in place.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/points/truth.h"
#include "tools/bench/run/euroc_folder.h"
#include "tools/bench/systems/experiment.h"
#include "vo/sequence/reader.h"

namespace vobench {

// Digest of the files that the motion in a world of points is read from; empty where there is none.
std::string DigestOfPointFiles(const sim::Scenario& scenario);

// Reads the world of a scenario and stores the names of its files in the cache. Throws BadInput where one cannot be
// read.
void FindWorld(const sim::Scenario& scenario, campaign::SequenceCache& cache);

// Input of a task. Without frames here: its scenario's rendering.
struct SeenSequence {
  Experiment experiment;  // of a recorded sequence's scenario camera, readout and rate alone
  SequenceFrames frames;
  Truth truth;
  campaign::Sensors sensors = {};     // available ones, of those that the campaign's systems use
  RecordedSensors beside_first = {};  // of a recorded one
  bool recorded() const { return !frames.empty(); }
};

// Throws settings::Error with every problem; keys are those of the campaign's entry (path, camera, first, frames) and
// of settings.
SeenSequence ReadRecording(const campaign::ScenarioEntry& entry, const campaign::Changes& changes,
                           campaign::Sensors wanted);

// Key of all inputs of the pictures: settings, contents of files, version of the program; of a recorded sequence the
// bytes of its pictures, their stamps, the truth and the camera. None where the files of the world have changed or were
// never found.
std::optional<std::string> SequenceKey(const SeenSequence& sequence, campaign::SequenceCache& cache);

// Renders the sequence, with `sensors` all cameras and mav0/ of euroc_folder.h, unless it exists, continuing an
// interrupted rendering. Waits for another process that renders it.
// Of a recorded one a folder in TUM's layout: lists, camera.yaml, and links to its pictures, made anew where these have
// moved. Throws BadInput, std::runtime_error.
void MakeIn(const campaign::SequenceCache& cache, const std::string& key, const SeenSequence& sequence, int jobs);

}  // namespace vobench
