// Content of a sequence: the files of each frame, those of the whole, and its provenance record, manifest.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/sequence/layout.h"
#include "sim/simulator.h"

namespace sim {

struct SequenceContent {
  Layout layout = Layout::tum;
  std::int64_t first = 0, last = 0;  // frames [first, last)
  std::string program;               // name and version, for the record
  bool rig = true;                   // all cameras of a rig; false: the first, as if it were the only one
};

// Throws std::invalid_argument for frames out of range and for streams that the layout does not support.
void Validate(const SequenceContent& content, const Simulator& simulator);

// The picture of a frame, relative to the sequence's folder.
std::string ImagePath(const Simulator& camera, const SequenceContent& content, std::int64_t index);

// Files of a frame, rendered and encoded: a pure function of its index.
std::vector<StreamFile> FrameFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t index);

// Lists, truth, camera, manifest of the first `whole` frames of the content. Of fewer frames no file is longer.
std::vector<StreamFile> WholeFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t whole);

inline constexpr char kManifestName[] = "manifest.json";

// JSON: program version, layout, seed, requested range of frames, number of frames written (`whole`), camera, scenario.
std::string Manifest(const Simulator& simulator, const SequenceContent& content, std::int64_t whole);

// Differences of two manifests apart from the number of frames: "scenario.sensor.exposure is 0.01 there, not 0.002", a
// line for each key; empty when one is a part of the other. Throws std::invalid_argument: `there` is no JSON object.
std::vector<std::string> ManifestDifferences(const std::string& there, const std::string& wanted);

}  // namespace sim
