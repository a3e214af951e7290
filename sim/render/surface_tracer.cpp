#include "sim/render/surface_tracer.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

#include "sim/render/placed_objects.h"
#include "sim/render/ray_scene.h"

namespace sim {
namespace {

// Up to sixteen rays from one eye.
struct Packet {
  RTCRayHit16 rays{};
  alignas(64) int valid[kLanes] = {};

  void Set(int i, const glm::dvec3& eye, const glm::dvec3& direction) {
    const glm::vec3 o(eye), d(direction);
    rays.ray.org_x[i] = o.x, rays.ray.org_y[i] = o.y, rays.ray.org_z[i] = o.z;
    rays.ray.dir_x[i] = d.x, rays.ray.dir_y[i] = d.y, rays.ray.dir_z[i] = d.z;
    rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
    rays.ray.mask[i] = 0xffffffffu;
    rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    valid[i] = -1;
  }
  bool Met(int i) const { return valid[i] != 0 && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID; }
};

// A world at one time: static geometry and, where there are any, its objects.
struct Snapshot {
  Snapshot(const RayScene& rays, const View& view, const std::vector<Pose>& poses)
      : scene(rays), objects(rays, view.t_s, view.t_s), T_WO(poses) {}

  void Meet(Packet& packet) const {
    Intersect16(packet.valid, scene.embree(), &packet.rays, true);
    if (objects.embree() != nullptr) Intersect16(packet.valid, objects.embree(), &packet.rays, false);
  }
  std::int32_t Object(const Packet& packet, int i) const {
    const std::uint32_t instance = packet.rays.hit.instID[0][i];
    return instance == RTC_INVALID_GEOMETRY_ID ? kWorld : static_cast<std::int32_t>(instance);
  }
  std::uint32_t Triangle(const Packet& packet, int i) const {
    const auto& hit = packet.rays.hit;
    return scene.Triangle(hit.instID[0][i], hit.geomID[i], hit.primID[i]);
  }

  // Plane of a triangle through which rays of one origin go, in the frame of the triangle's object.
  struct Plane {
    std::uint32_t triangle = kNoTriangle;
    std::int32_t object = kWorld;
    glm::dquat q_OW{1, 0, 0, 0};
    glm::dvec3 normal{0};
    double offset = 0;  // of the origin, along the normal
  };
  // Intersection of ray i with its triangle's plane, in double: Embree's own distance is single precision, and is kept
  // at a grazing angle. `plane`: of the ray before, reused while the triangle is the same.
  double PlaneDistance(const Packet& packet, int i, const glm::dvec3& origin, const glm::dvec3& direction,
                       Plane& plane) const {
    const std::uint32_t triangle = Triangle(packet, i);
    const std::int32_t object = Object(packet, i);
    if (triangle != plane.triangle || object != plane.object) {
      glm::dvec3 origin_O = origin;
      if (object != kWorld) {
        const Pose& pose = T_WO[static_cast<std::size_t>(object)];
        plane.q_OW = glm::conjugate(pose.q_WC);
        origin_O = plane.q_OW * (origin - pose.p_WC);
      }
      plane.triangle = triangle;
      plane.object = object;
      plane.normal = scene.AreaNormal(triangle);
      plane.offset = glm::dot(plane.normal, glm::dvec3(scene.Corner(triangle, 0)) - origin_O);
    }
    const double embree = packet.rays.ray.tfar[i];
    const double distance =
        plane.offset / glm::dot(plane.normal, object == kWorld ? direction : plane.q_OW * direction);
    return std::abs(distance - embree) <= 1e-4 * embree ? distance : embree;
  }

  const RayScene& scene;
  const PlacedObjects objects;
  const std::vector<Pose> T_WO;
};

template <class Function>
void ForEachPacket(int jobs, std::size_t count, const Function& function) {
  tbb::task_arena arena(jobs > 0 ? jobs : tbb::task_arena::automatic);
  const std::size_t packets = (count + kLanes - 1) / kLanes;
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, packets, function); });
}

}  // namespace

// function(snapshot, packet, lane, pixel, X_C) where the ray through the centre of `pixel` meets the world.
template <class Function>
void SurfaceTracer::ForEachHit(const Camera& camera, const View& view, const Function& function) const {
  const Pose& pose = view.pose;
  const Snapshot snapshot(scene_, view, ObjectPoses(view.t_s));
  const int width = camera.width(), blocks_x = (width + kBlockSide - 1) / kBlockSide,
            blocks_y = (camera.height() + kBlockSide - 1) / kBlockSide;
  const glm::dmat3 rotation = glm::mat3_cast(pose.q_WC);
  const std::size_t lanes = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y) * kLanes;
  ForEachPacket(jobs_, lanes, [&](std::size_t block) {
    const int x0 = static_cast<int>(block % static_cast<std::size_t>(blocks_x)) * kBlockSide,
              y0 = static_cast<int>(block / static_cast<std::size_t>(blocks_x)) * kBlockSide;
    Packet packet;
    glm::dvec3 ray[kLanes], direction[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const int x = x0 + i % kBlockSide, y = y0 + i / kBlockSide;
      if (x >= width || y >= camera.height()) continue;
      ray[i] = camera.PixelRay(x, y);
      direction[i] = rotation * ray[i];
      packet.Set(i, pose.p_WC, direction[i]);
    }
    snapshot.Meet(packet);
    Snapshot::Plane plane;
    for (int i = 0; i < kLanes; ++i) {
      if (!packet.Met(i)) continue;
      const auto x = static_cast<std::size_t>(x0 + i % kBlockSide), y = static_cast<std::size_t>(y0 + i / kBlockSide);
      function(snapshot, packet, i, y * static_cast<std::size_t>(width) + x,
               snapshot.PlaneDistance(packet, i, pose.p_WC, direction[i], plane) * ray[i]);
    }
  });
}

void SurfaceTracer::Trace(const Camera& camera, const View& view, std::vector<SurfacePoint>& out) const {
  out.assign(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()), {});
  ForEachHit(camera, view,
             [&](const Snapshot& at, const Packet& packet, int i, std::size_t pixel, const glm::dvec3& X_C) {
               const auto& hit = packet.rays.hit;
               out[pixel] = {at.Triangle(packet, i), hit.u[i], hit.v[i], at.Object(packet, i), X_C.z, X_C};
             });
}

std::vector<float> SurfaceTracer::Depth(const Camera& camera, const View& view) const {
  std::vector<float> depth(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()));
  ForEachHit(camera, view, [&](const Snapshot&, const Packet&, int, std::size_t pixel, const glm::dvec3& X_C) {
    depth[pixel] = static_cast<float>(X_C.z);
  });
  return depth;
}

void SurfaceTracer::Visible(const View& view, std::span<const glm::dvec3> points_W,
                            std::vector<std::uint8_t>& out) const {
  constexpr double kOwnSurface = 1e-5;
  const glm::dvec3& eye_W = view.pose.p_WC;
  const Snapshot snapshot(scene_, view, ObjectPoses(view.t_s));
  out.assign(points_W.size(), 1);
  ForEachPacket(jobs_, points_W.size(), [&](std::size_t packet_index) {
    const std::size_t first = packet_index * kLanes;
    const int count = static_cast<int>(std::min<std::size_t>(kLanes, points_W.size() - first));
    Packet packet;
    for (int i = 0; i < count; ++i) packet.Set(i, eye_W, points_W[first + static_cast<std::size_t>(i)] - eye_W);
    snapshot.Meet(packet);
    Snapshot::Plane plane;
    for (int i = 0; i < count; ++i) {
      if (!packet.Met(i)) continue;  // the ray missed at an edge: nothing is in front of the point
      const std::size_t at = first + static_cast<std::size_t>(i);
      out[at] = snapshot.PlaneDistance(packet, i, eye_W, points_W[at] - eye_W, plane) >= 1 - kOwnSurface;
    }
  });
}

std::vector<Pose> SurfaceTracer::ObjectPoses(double t_s) const {
  std::vector<Pose> poses;
  for (const RayObject& object : scene_.objects()) poses.push_back(object.PoseAt(t_s));
  return poses;
}

glm::dvec3 SurfaceTracer::Normal(std::uint32_t triangle) const { return scene_.AreaNormal(triangle); }

std::uint32_t SurfaceTracer::MeshOf(std::uint32_t triangle) const { return scene_.MeshOf(triangle); }

}  // namespace sim
