// Purpose: a simulated sequence on disk, in the layout of docs/sequence_format.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace sim {

// Usage:  SequenceWriter writer(simulator, folder, first, last, jobs, version);
//         while (writer.WriteBatch() > 0) {}      // progress in between
//         writer.Finish();
// The folder appears under its name when it is whole; until then everything is under a hidden name beside it, and is
// removed when something goes wrong or the writer is destroyed before Finish. Bytes do not depend on `jobs`, and those
// of a frame not on the range.
class SequenceWriter {
 public:
  // Frames [first, last) of the simulator, which must outlive the writer. `folder` must not exist or be empty. Throws
  // std::invalid_argument for a bad range or jobs < 1, std::runtime_error naming the folder when it cannot be made.
  SequenceWriter(const Simulator& simulator, const std::filesystem::path& folder, std::int64_t first, std::int64_t last,
                 int jobs, const std::string& program_version);
  ~SequenceWriter();
  SequenceWriter(const SequenceWriter&) = delete;
  SequenceWriter& operator=(const SequenceWriter&) = delete;

  // Renders and writes the next frames, `jobs` of them at the same time, and returns how many; 0 when none is left.
  // Memory is that of `jobs` frames. Throws std::runtime_error naming the file that could not be written, and why.
  std::int64_t WriteBatch();

  // Writes the lists, the truth, the camera and the manifest, and gives the folder its name. Throws like WriteBatch;
  // std::logic_error while frames are left.
  void Finish();

 private:
  void Discard();

  const Simulator& simulator_;
  std::filesystem::path folder_, temporary_;
  std::vector<std::filesystem::path> made_parents_;  // innermost first
  std::int64_t first_, last_, next_;
  int jobs_;
  std::string version_;
};

}  // namespace sim
