// Depth and optical flow of kept frames as pictures in colour.
// Source: docs/result_folder.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/simulator.h"

namespace vobench {

// Of the frames that are kept as pictures. Colours mean the same in all of them, so they are made at the end; until
// then every frame takes a third of a megabyte.
class TruthPictures {
 public:
  void Add(const sim::Simulator& simulator, std::int64_t index);

  // OUT/truth/. Throws std::runtime_error.
  void Write(const std::filesystem::path& out) const;

 private:
  struct Frame {
    std::int64_t stamp_ns = 0;
    cv::Mat depth, flow;  // [m]; [px] to the next frame, of the last frame none
  };
  std::vector<Frame> frames_;
};

}  // namespace vobench
