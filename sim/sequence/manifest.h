// Provenance record of a sequence: manifest.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/sequence/content.h"

namespace sim {

inline constexpr char kManifestName[] = "manifest.json";

// JSON: program version, layout, seed, range of frames asked for, frames that are there (`whole`), camera, scenario.
std::string Manifest(const Simulator& simulator, const SequenceContent& content, std::int64_t whole);

// Differences of two manifests apart from the number of frames: "scenario.sensor.exposure is 0.01 there, not 0.002",
// one line for each key; empty when the one sequence is a part of the other. Throws std::invalid_argument when `there`
// is no JSON object.
std::vector<std::string> ManifestDifferences(const std::string& there, const std::string& wanted);

}  // namespace sim
