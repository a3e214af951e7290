#include "sim/scenario/truth_streams.h"

#include <array>

namespace sim {
namespace {

constexpr std::array<std::string_view, 13> kNames = {
    "depth",     "depth_exr",  "depth_kinect", "distance",  "normals",      "flow", "flow_backward",
    "occlusion", "surface_id", "moving",       "landmarks", "acceleration", "imu"};
static_assert(kNames.size() == static_cast<std::size_t>(TruthStream::imu) + 1);

}  // namespace

std::string Name(TruthStream stream) { return std::string(kNames[static_cast<std::size_t>(stream)]); }

std::optional<TruthStream> TruthStreamOf(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<TruthStream>(i);
  }
  return std::nullopt;
}

std::string TruthStreamList() {
  std::string list;
  for (const std::string_view name : kNames) list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

}  // namespace sim
