// Frame viewer of a report: selected pictures with features and truth, and their JSON.
// Source: docs/report_data.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/bench/result/pictures.h"
#include "tools/bench/result/result.h"

namespace vobench::report {

struct ViewedFrame {
  double t_s = 0;                                  // as in the figures
  std::string picture, depth, flow;                // JPEG; the latter two empty without truth
  std::vector<std::vector<FeatureMark>> features;  // [system]
};

struct FrameViewer {
  int width = 0, height = 0;  // of the camera's image [px]
  TruthScale scale;
  std::vector<ViewedFrame> frames;
};

// Frames of each system's typical run; systems have the same pictures, so one of each stamp is kept. Evenly thinned
// where all would take more than `bytes`. Throws evaluation::InputError where a picture cannot be read.
FrameViewer MakeFrameViewer(const std::filesystem::path& out, const ResultData& data, std::size_t bytes);

nlohmann::ordered_json ToJson(const FrameViewer& viewer);

}  // namespace vobench::report
