// Frame viewer of a report: selected pictures with features and truth, and their JSON.
// Source: docs/report_data.md.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
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

// Of each system's typical run; systems see the same pictures, so one of each stamp is kept. Evenly fewer where all
// would take more than `bytes`. Throws evaluation::InputError where a picture cannot be read.
FrameViewer MakeFrameViewer(const std::filesystem::path& out, const ResultData& data, std::size_t bytes);

// Of runs that are not done yet: the frame that they have just seen, features by run, in the order of data.runs.
FrameViewer NewestFrame(const ResultData& data, std::int64_t stamp_ns, const Eigen::Vector2i& size, std::string picture,
                        std::span<const std::vector<FeatureMark>> features);

nlohmann::ordered_json ToJson(const FrameViewer& viewer);

}  // namespace vobench::report
