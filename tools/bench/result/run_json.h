// run.json of a result folder: description of a run, sufficient to repeat it.
// Source: docs/result_folder.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/result/calibration_record.h"

namespace vobench {

// One run: one system with one seed.
struct RunEntry {
  std::string system;  // "rb2pf", "rbpf", ...
  std::uint64_t seed = 0;
  std::string path;    // of the run folder, relative to the result folder: "rb2pf/seed_1", or "." for `track`
  double seconds = 0;  // wall time of this run
  std::optional<CalibrationRecord> calibration = std::nullopt;  // where it was estimated
};

struct RunDescription {
  std::string title;                                 // for people: the scenario's or the sequence's name
  std::string input;                                 // scenario file or sequence folder, as given
  std::string command;                               // the command line
  std::string started_utc;                           // ISO 8601, "2026-01-31T12:00:00Z"
  double seconds = 0;                                // wall time of everything
  std::string settings = {};                         // all of them, resolved, as YAML
  std::map<std::string, std::string> versions = {};  // program and libraries, by name
  std::vector<std::string> notes = {};               // for the reader: warnings, coasted gaps
  std::vector<std::string> verdicts = {};            // in a sentence each, where requested (--verdict)
  std::vector<RunEntry> runs = {};
};

// Writes OUT/run.json atomically; throws std::runtime_error on failure.
void WriteRunJson(const std::filesystem::path& out, const RunDescription& description);

// Throws std::invalid_argument naming the file and every field that is missing or of the wrong type, and run folders
// that lead out of the result folder.
RunDescription ReadRunJson(const std::filesystem::path& out);

}  // namespace vobench
