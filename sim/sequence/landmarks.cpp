#include "sim/sequence/landmarks.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "sim/random/random.h"
#include "sim/render/surface_tracer.h"
#include "sim/sequence/flow.h"

namespace sim {
namespace {

std::vector<SurfaceLandmark> Candidates(const Simulator& simulator, std::size_t count) {
  const std::int64_t frames = std::min<std::int64_t>(simulator.frame_count(), 64);
  std::vector<SurfaceLandmark> candidates;
  std::vector<SurfacePoint> points;
  for (std::int64_t f = 0; f < frames; ++f) {
    const std::int64_t index = frames == 1 ? 0 : f * (simulator.frame_count() - 1) / (frames - 1);
    const Truth truth = simulator.TruthAt(index);
    simulator.surfaces().Trace(simulator.camera(), simulator.ViewAt(index), points);
    const std::size_t end = count * static_cast<std::size_t>(f + 1) / static_cast<std::size_t>(frames);
    for (std::size_t i = count * static_cast<std::size_t>(f) / static_cast<std::size_t>(frames); i < end; ++i) {
      const Words words =
          RandomWords(simulator.scenario().seed, Stream::landmark_place, 0, static_cast<std::uint32_t>(i), 0);
      const auto pixel = static_cast<std::size_t>(Uniform(words[0], words[1]) * static_cast<double>(points.size()));
      if (points[pixel].triangle == kNoTriangle || points[pixel].object != kWorld) continue;
      candidates.push_back(
          {truth.p_WC + truth.q_WC * points[pixel].X_C, simulator.surfaces().MeshOf(points[pixel].triangle)});
    }
  }
  return candidates;
}

}  // namespace

std::vector<SurfaceLandmark> SpreadLandmarks(const Simulator& simulator, int count) {
  const auto wanted = static_cast<std::size_t>(count);
  const std::vector<SurfaceLandmark> candidates = Candidates(simulator, 8 * wanted);
  std::vector<SurfaceLandmark> taken;
  std::vector<double> gap(candidates.size(), std::numeric_limits<double>::infinity());  // squared, to those taken
  for (std::size_t next = 0; taken.size() < wanted && next < candidates.size() && gap[next] > 0;) {
    taken.push_back(candidates[next]);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const glm::dvec3 d = candidates[i].X_W - candidates[next].X_W;
      gap[i] = std::min(gap[i], glm::dot(d, d));
    }
    next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
  }
  return taken;
}

std::vector<LandmarkView> ViewsOf(const Simulator& simulator, const std::vector<SurfaceLandmark>& landmarks,
                                  std::int64_t frame) {
  const Truth truth = simulator.TruthAt(frame);
  const glm::dquat q_CW = glm::conjugate(truth.q_WC);
  std::vector<LandmarkView> views;
  std::vector<glm::dvec3> points;
  for (std::size_t id = 0; id < landmarks.size(); ++id) {
    const glm::dvec3 X_C = q_CW * (landmarks[id].X_W - truth.p_WC);
    if (!HasPixel(simulator.camera(), X_C)) continue;
    const glm::dvec2 pixel = simulator.camera().Project(X_C);
    if (!InImage(simulator.camera(), X_C, pixel)) continue;
    views.push_back({static_cast<std::uint32_t>(id), pixel, false});
    points.push_back(landmarks[id].X_W);
  }
  std::vector<std::uint8_t> visible;
  simulator.surfaces().Visible(simulator.ViewAt(frame), points, visible);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].visible = visible[i] != 0;
  return views;
}

}  // namespace sim
