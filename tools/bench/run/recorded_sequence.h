// Recorded sequence of a campaign, read where it lies: what `vobench track` knows of it, and its truth for the judge.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/points/truth.h"
#include "tools/bench/systems/experiment.h"
#include "vo/geometry/camera.h"
#include "vo/sequence/reader.h"

namespace vobench {

// A preset or a file; or else the sequence's own camera.yaml, or EuRoC's sensor.yaml. Throws settings::Error,
// std::invalid_argument.
vo::Camera CameraOfSequence(const std::filesystem::path& sequence, const std::optional<std::string>& camera);

// Camera and settings of a tracked sequence, as JSON.
std::string RecordOfTracking(const vo::Camera& camera, const std::string& settings);

// Throws settings::Error with every problem; keys are those of the campaign's entry (path, camera, first, frames) and
// of settings.
struct Recording {
  Recording(const campaign::ScenarioEntry& entry, const campaign::Changes& changes);

  Experiment experiment;  // of its scenario camera, readout and rate alone
  std::vector<vo::SequenceReader::Entry> frames;
  Truth truth;
};

// The name of its frames in the cache: by the bytes of the pictures, their stamps, the truth, and the camera.
std::string KeyOf(const Recording& recording, campaign::SequenceCache& cache);

// A folder in TUM's layout in the cache: lists, camera.yaml, and links to the recorded pictures. Made anew where these
// lie elsewhere by now. Throws std::runtime_error.
void LinkInto(const campaign::SequenceCache& cache, const std::string& key, const Recording& recording);

}  // namespace vobench
