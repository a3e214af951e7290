// Selection of the truth streams of a sequence, beside poses and velocities, which are always there.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "sim/motion/imu.h"

namespace sim {

// docs/truth.md says what each is and how exact.
enum class TruthStream {
  depth,         // 16-bit PNG
  depth_exr,     // the same in float
  depth_kinect,  // 16-bit PNG, with a structured-light camera's noise: sim/sensor/depth_noise.h
  distance,
  normals,
  flow,           // to the next frame
  flow_backward,  // to the one before
  occlusion,      // what of each flow cannot be seen in the other frame
  surface_id,
  moving,  // which pixels see an object that moves
  landmarks,
  acceleration,
  imu
};

std::string Name(TruthStream stream);
std::optional<TruthStream> TruthStreamOf(std::string_view name);
std::string TruthStreamList();  // "depth, depth_exr, ...": for messages

struct TruthParams {
  std::set<TruthStream> streams{TruthStream::depth};
  int landmarks = 500;
  ImuParams imu;
};

// But for the list of streams.
template <class V>
void Visit(V& v, TruthParams& p) {
  v.Child("landmarks", [&](auto& landmarks) {
    landmarks("count", p.landmarks, {settings::Range{1, 100000}, "surface points that are tracked"});
  });
  v.Child("imu", p.imu);
}

}  // namespace sim
