#include "sim/render/placed_objects.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace sim {
namespace {

constexpr double kPathError = 1e-6;  // [m]
constexpr int kFewestParts = 4;      // where there is an interval: a single midpoint may agree by chance
constexpr int kMostParts = 128;
static_assert(kMostParts + 1 <= RTC_MAX_TIME_STEP_COUNT);

glm::dvec3 Apply(const Pose& pose, const glm::dvec3& X_O) { return pose.q_WC * X_O + pose.p_WC; }

// Largest deviation of the linearly interpolated pose from the pose in between, at the corners of the object's box.
double Departure(const RayObject& object, const Pose& from, const Pose& middle, const Pose& to) {
  double worst = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 X_O(corner & 1 ? object.high.x : object.low.x, corner & 2 ? object.high.y : object.low.y,
                         corner & 4 ? object.high.z : object.low.z);
    const glm::dvec3 straight = 0.5 * (Apply(from, X_O) + Apply(to, X_O));
    worst = std::max(worst, glm::length(straight - Apply(middle, X_O)));
  }
  return worst;
}

int PartsOf(const RayObject& object, double begin_s, double end_s) {
  int parts = kFewestParts;
  for (; parts < kMostParts; parts *= 2) {
    const double half_s = 0.5 * (end_s - begin_s) / parts;
    double worst = 0;
    for (int i = 0; i < parts && worst <= kPathError; ++i) {
      const double middle_s = begin_s + (2 * i + 1) * half_s;
      worst = std::max(worst, Departure(object, object.PoseAt(middle_s - half_s), object.PoseAt(middle_s),
                                        object.PoseAt(middle_s + half_s)));
    }
    if (worst <= kPathError) break;
  }
  return parts;
}

}  // namespace

PlacedObjects::PlacedObjects(const RayScene& scene, double begin_s, double end_s) : begin_s_(begin_s), end_s_(end_s) {
  const std::vector<RayObject>& objects = scene.objects();
  if (objects.empty()) return;
  int parts = 0;
  if (end_s > begin_s) {
    for (const RayObject& object : objects) parts = std::max(parts, PartsOf(object, begin_s, end_s));
  }
  const RTCDevice device = scene.device();
  scene_ = NewTree(device);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, objects[k].tree.get());
    rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(parts) + 1);
    for (int i = 0; i <= parts; ++i) {
      const Pose pose = objects[k].PoseAt(parts > 0 ? begin_s + i * (end_s - begin_s) / parts : begin_s);
      const glm::dmat3 rotation = glm::mat3_cast(pose.q_WC);
      float columns[12];
      for (int c = 0; c < 3; ++c) {
        for (int row = 0; row < 3; ++row) columns[3 * c + row] = static_cast<float>(rotation[c][row]);
        columns[9 + c] = static_cast<float>(pose.p_WC[c]);
      }
      rtcSetGeometryTransform(instance, static_cast<unsigned>(i), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
      turns_.insert(turns_.end(), columns, columns + 9);
    }
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene_.get(), instance, static_cast<unsigned>(k));
    rtcReleaseGeometry(instance);
  }
  CommitTree(scene_);
  CheckEmbree(device, "placing the objects");
  packet_ = {scene_.get(), scene.first_triangles(), turns_.data(), parts + 1, false};
}

}  // namespace sim
