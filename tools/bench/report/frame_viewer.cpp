#include "tools/bench/report/frame_viewer.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/base/files.h"
#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench::report {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string ReadBytes(const fs::path& file) {
  std::optional<std::string> bytes = base::ReadFile(file);
  if (!bytes) throw evaluation::InputError({file.string() + ": cannot be read"});
  return std::move(*bytes);
}

std::string ReadIfThere(const fs::path& file) { return fs::exists(file) ? ReadBytes(file) : std::string(); }

std::size_t Bytes(const ViewedFrame& frame) {
  std::size_t features = 0;
  for (const auto& marks : frame.features) features += marks.size();
  return frame.picture.size() + frame.depth.size() + frame.flow.size() + 28 * features;
}

// Every n-th, n as small as the room allows; none where not even one fits.
std::vector<ViewedFrame> Fitting(std::vector<ViewedFrame> frames, std::size_t bytes) {
  for (std::size_t every = 1; every <= frames.size(); ++every) {
    std::vector<ViewedFrame> kept;
    std::size_t total = 0;
    for (std::size_t i = every / 2; i < frames.size(); i += every) total += Bytes(frames[i]);
    if (total > bytes) continue;
    for (std::size_t i = every / 2; i < frames.size(); i += every) kept.push_back(std::move(frames[i]));
    return kept;
  }
  return {};
}

// Tenths of a pixel: [status, predicted, pixel, innovation covariance].
Json Of(const FeatureMark& mark) {
  const auto tenth = [](double value) { return std::round(10 * value) / 10; };
  const Eigen::Matrix2d& S = mark.covariance;
  Json numbers = {static_cast<int>(mark.status)};
  for (const Eigen::Vector2d& at : {mark.predicted, mark.pixel})
    for (const double value : at) numbers.push_back(tenth(value));
  for (const double value : {S(0, 0), S(0, 1), S(1, 1)}) numbers.push_back(tenth(value));
  return numbers;
}

}  // namespace

FrameViewer MakeFrameViewer(const fs::path& out, const ResultData& data, std::size_t bytes) {
  FrameViewer viewer;
  viewer.scale = ReadTruthScale(out);
  const std::vector<std::string> systems = data.Systems();
  std::map<std::int64_t, ViewedFrame> frames;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const RunData& run = data.Typical(systems[s]);
    if (run.pictures.pictures.empty()) continue;
    viewer.width = run.pictures.width;
    viewer.height = run.pictures.height;
    for (const KeptPicture& picture : run.pictures.pictures) {
      ViewedFrame& frame = frames[picture.stamp_ns];
      if (frame.picture.empty()) {
        frame.t_s = Seconds(data, picture.stamp_ns);
        frame.picture = ReadBytes(out / run.entry.path / PicturePath(picture.stamp_ns));
        frame.depth = ReadIfThere(out / DepthPath(picture.stamp_ns));
        frame.flow = ReadIfThere(out / FlowPath(picture.stamp_ns));
        frame.features.resize(systems.size());
      }
      frame.features[s] = picture.features;
    }
  }
  std::vector<ViewedFrame> all;
  for (auto& [stamp, frame] : frames) all.push_back(std::move(frame));
  viewer.frames = Fitting(std::move(all), bytes);
  return viewer;
}

Json ToJson(const FrameViewer& viewer) {
  Json json = {{"width", viewer.width}, {"height", viewer.height}};
  if (viewer.scale.farthest_m > 0) json["depth_m"] = {viewer.scale.nearest_m, viewer.scale.farthest_m};
  if (viewer.scale.largest_flow_px > 0) json["flow_px"] = viewer.scale.largest_flow_px;
  json["frames"] = Json::array();
  for (const ViewedFrame& frame : viewer.frames) {
    Json entry = {{"t", frame.t_s}, {"picture", Base64(frame.picture)}};
    if (!frame.depth.empty()) entry["depth"] = Base64(frame.depth);
    if (!frame.flow.empty()) entry["flow"] = Base64(frame.flow);
    entry["features"] = Json::array();
    for (const auto& marks : frame.features) {
      Json features = Json::array();
      for (const FeatureMark& mark : marks) features.push_back(Of(mark));
      entry["features"].push_back(features);
    }
    json["frames"].push_back(entry);
  }
  return json;
}

}  // namespace vobench::report
