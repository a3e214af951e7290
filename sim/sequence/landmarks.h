// Surface landmarks of a sequence, and their views in each frame.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/simulator.h"

namespace sim {

struct SurfaceLandmark {
  glm::dvec3 X_W{0.0};     // [m]
  std::uint32_t mesh = 0;  // index in Scene::meshes
};

// `count` points (fewer where the camera sees almost nothing), spread over the static surfaces: candidates lie under
// random pixels (keyed by seed) of up to 64 frames spread over the whole scenario; of 8 `count` candidates each next
// one taken is the farthest from those taken before (farthest-point sampling). A function of the scenario alone.
std::vector<SurfaceLandmark> SpreadLandmarks(const Simulator& simulator, int count);

struct LandmarkView {
  std::uint32_t id = 0;  // index in the landmarks
  glm::dvec2 pixel{0.0};
  bool visible = false;  // false: another surface is before it
};

// Those whose projection at the frame's stamp lies in the image, in the order of their ids.
std::vector<LandmarkView> ViewsOf(const Simulator& simulator, const std::vector<SurfaceLandmark>& landmarks,
                                  std::int64_t frame);

}  // namespace sim
