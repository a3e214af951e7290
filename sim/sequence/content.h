// Content of a sequence: the files of each frame, and those of the whole.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/sequence/layout.h"
#include "sim/sequence/stream_file.h"
#include "sim/simulator.h"

namespace sim {

struct SequenceContent {
  Layout layout = Layout::tum;
  std::int64_t first = 0, last = 0;  // frames [first, last)
  std::string program;               // name and version, for the record
};

// Throws std::invalid_argument for frames that the simulator does not have, and for what the layout cannot say.
void Validate(const SequenceContent& content, const Simulator& simulator);

// Everything that is a frame's own, rendered and encoded: a pure function of its index, whatever else is written.
std::vector<StreamFile> FrameFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t index);

// Lists, truth, camera, manifest of the first `whole` frames of the content. Of fewer frames no file is longer.
std::vector<StreamFile> WholeFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t whole);

}  // namespace sim
