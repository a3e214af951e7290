#include "tools/bench/run/truth_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/render/surface_tracer.h"
#include "sim/sequence/flow.h"
#include "tools/bench/result/pictures.h"
#include "tools/bench/tracking/picture.h"

namespace vobench {
namespace {

constexpr int kWidest = 240;

// The value that such a share of the sorted ones lies below: a few outliers must not take all colours.
double Quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

void TruthPictures::Add(const sim::Simulator& simulator, std::int64_t index) {
  const sim::Camera& camera = simulator.camera();
  const sim::View view = simulator.ViewAt(index);
  std::vector<sim::SurfacePoint> points;
  simulator.surfaces().Trace(camera, view, points);
  sim::FlowImage flow;
  if (index + 1 < simulator.frame_count()) {
    flow = sim::FlowBetween(simulator.surfaces(), camera, points, view, simulator.ViewAt(index + 1));
  }
  // Every n-th pixel: neither depth nor flow may be averaged over an edge.
  const int every = (camera.width() + kWidest - 1) / kWidest;
  Frame& frame = frames_.emplace_back();
  frame.stamp_ns = simulator.StampNs(index);
  frame.depth.create(camera.height() / every, camera.width() / every, CV_32FC1);
  if (!flow.uv.empty()) frame.flow.create(frame.depth.size(), CV_32FC2);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y * every) * static_cast<std::size_t>(camera.width()) +
                                static_cast<std::size_t>(x * every);
      frame.depth.at<float>(y, x) = static_cast<float>(points[pixel].depth);
      if (frame.flow.empty()) continue;
      const float u = flow.uv[2 * pixel], v = flow.uv[2 * pixel + 1];
      const bool known = std::abs(u) < 1e9F && std::abs(v) < 1e9F;
      frame.flow.at<cv::Vec2f>(y, x) = known ? cv::Vec2f(u, v) : cv::Vec2f(kNaN, kNaN);
    }
  }
}

void TruthPictures::Write(const std::filesystem::path& out) const {
  std::vector<float> depths, lengths;
  for (const Frame& frame : frames_) {
    for (const float z : cv::Mat_<float>(frame.depth)) {
      if (z > 0 && std::isfinite(z)) depths.push_back(z);
    }
    if (frame.flow.empty()) continue;
    for (const cv::Vec2f& uv : cv::Mat_<cv::Vec2f>(frame.flow)) {
      if (std::isfinite(uv[0]) && std::isfinite(uv[1])) lengths.push_back(std::hypot(uv[0], uv[1]));
    }
  }
  const TruthScale scale{Quantile(depths, 0.01), Quantile(depths, 0.99), Quantile(lengths, 0.99)};
  if (!(scale.farthest_m > 0)) return;  // nothing was ever seen
  std::filesystem::create_directories(out / "truth");
  for (const Frame& frame : frames_) {
    WritePicture(out / DepthPath(frame.stamp_ns), DepthColours(frame.depth, scale.nearest_m, scale.farthest_m));
    if (frame.flow.empty() || !(scale.largest_flow_px > 0)) continue;
    WritePicture(out / FlowPath(frame.stamp_ns), FlowColours(frame.flow, scale.largest_flow_px));
  }
  WriteTruthScale(out, scale);
}

}  // namespace vobench
