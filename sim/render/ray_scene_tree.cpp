// Embree's trees of a scene, and what Embree asks at hits of cut-outs and lamps.
#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>

#include "sim/render/ray_scene.h"

namespace sim {
namespace {

// Asked for each hit of the second geometry by a ray: leaves valid[i] as it is where there is a surface, else sets it
// to 0.
void FilterHits(const RTCFilterFunctionNArguments* arguments, bool shadow) {
  const auto* filters = static_cast<const RayScene::Filter*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const RayScene::Filter& filter = filters[RTCHitN_primID(arguments->hit, n, i)];
    if (filter.lamp) {
      const float along = RTCHitN_Ng_x(arguments->hit, n, i) * RTCRayN_dir_x(arguments->ray, n, i) +
                          RTCHitN_Ng_y(arguments->hit, n, i) * RTCRayN_dir_y(arguments->ray, n, i) +
                          RTCHitN_Ng_z(arguments->hit, n, i) * RTCRayN_dir_z(arguments->ray, n, i);
      if (shadow || along > 0) arguments->valid[i] = 0;
      continue;
    }
    const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
    const float alpha =
        filter.factor *
        (filter.alpha != nullptr ? filter.alpha->Alpha(filter.uv + u * filter.uv_du + v * filter.uv_dv) : 1.0f);
    if (alpha < filter.cutoff) arguments->valid[i] = 0;
  }
}

void FilterIntersect(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, false); }

void FilterOccluded(const RTCFilterFunctionNArguments* arguments) { FilterHits(arguments, true); }

}  // namespace

void RayScene::Attach(RTCScene to, std::size_t begin, std::size_t end, bool filtered, std::size_t first_filter) const {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::span<const glm::uvec3> triangles(triangles_.data() + begin, end - begin);
  std::uint32_t low = ~0u, high = 0;  // of the vertices
  for (const glm::uvec3& t : triangles) low = std::min({low, t.x, t.y, t.z}), high = std::max({high, t.x, t.y, t.z});
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           std::size_t{high} - low + 1);
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                          triangles.size());
  if (vertices != nullptr && indices != nullptr) {
    std::copy(positions_.begin() + low, positions_.begin() + high + 1, static_cast<glm::vec3*>(vertices));
    std::transform(triangles.begin(), triangles.end(), static_cast<glm::uvec3*>(indices),
                   [low](const glm::uvec3& t) { return t - low; });
    if (filtered) {
      rtcSetGeometryUserData(geometry, const_cast<Filter*>(filters_.data() + first_filter));  // Embree only hands it on
      rtcSetGeometryIntersectFilterFunction(geometry, FilterIntersect);
      rtcSetGeometryOccludedFilterFunction(geometry, FilterOccluded);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, filtered ? 1 : 0);
  }
  rtcReleaseGeometry(geometry);
}

EmbreeScene RayScene::NewTree() const {
  EmbreeScene tree(rtcNewScene(device_.get()));
  rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
  return tree;
}

void RayScene::Build() {
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  // In one thread: where triangles touch, which one a ray meets may depend on the tree, and the tree on the threads.
  const auto commit = [](RTCScene tree) { tbb::task_arena(1).execute([tree] { rtcCommitScene(tree); }); };
  scene_ = NewTree();
  if (filtered_first_ > 0) Attach(scene_.get(), 0, filtered_first_, false, 0);
  if (filtered_first_ < still_triangles_) Attach(scene_.get(), filtered_first_, still_triangles_, true, 0);
  commit(scene_.get());
  std::size_t first_filter = still_triangles_ - filtered_first_;
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    const auto begin = static_cast<std::size_t>(first_triangles_[2 * k]),
               filtered = static_cast<std::size_t>(first_triangles_[2 * k + 1]),
               end =
                   k + 1 < objects_.size() ? static_cast<std::size_t>(first_triangles_[2 * k + 2]) : triangles_.size();
    objects_[k].tree = NewTree();
    if (begin < filtered) Attach(objects_[k].tree.get(), begin, filtered, false, 0);
    if (filtered < end) Attach(objects_[k].tree.get(), filtered, end, true, first_filter);
    first_filter += end - filtered;
    commit(objects_[k].tree.get());
  }
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree: building the scene failed, error " + std::to_string(error));
}

}  // namespace sim
