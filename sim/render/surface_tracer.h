// Exact ray-surface intersections of pixel centres: source of depth, flow, normals and surface ids.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/sensor/camera.h"

namespace sim {

class RayScene;

constexpr std::uint32_t kNoTriangle = 0xffffffffu;
constexpr std::int32_t kWorld = -1;  // no object that moves

// Intersection of a pixel centre's ray with the world: triangle and barycentric coordinates, which are constant for a
// point of a moving object.
struct SurfacePoint {
  std::uint32_t triangle = kNoTriangle;  // of all meshes, one after the other; kNoTriangle: nothing is seen
  float u = 0, v = 0;                    // corner 0 + u (corner 1 - corner 0) + v (corner 2 - corner 0)
  std::int32_t object = kWorld;          // in Scene::objects, which the triangle is of
  double depth = 0;                      // Z in C [m]; beside or behind a fisheye lens it is 0 or less
  glm::dvec3 X_C{0.0};                   // in C [m], on the ray to 1e-6 px and on the triangle's plane, in double
};

// Queries of a scene's geometry; the same results with any number of threads. Calls from several threads are allowed.
class SurfaceTracer {
 public:
  // The scene must outlive the tracer. jobs: threads; 0: as many as the machine has.
  SurfaceTracer(const RayScene& scene, int jobs) : scene_(scene), jobs_(jobs) {}

  // Through each pixel's centre, rows from the top. `out` is resized.
  void Trace(const Camera& camera, const View& view, std::vector<SurfacePoint>& out) const;
  // SurfacePoint::depth alone, in a fraction of the memory.
  std::vector<float> Depth(const Camera& camera, const View& view) const;

  // For each point X (W, on a surface), whether no other surface lies between it and the view's eye: 1 or 0. What lies
  // less than 1e-5 of the distance before the point is taken for the point's own surface.
  void Visible(const View& view, std::span<const glm::dvec3> points_W, std::vector<std::uint8_t>& out) const;

  // T_WO of each of Scene::objects.
  std::vector<Pose> ObjectPoses(double t_s) const;
  // Of the triangle, in W, an object's in O, not normalised: (corner 1 - corner 0) x (corner 2 - corner 0).
  glm::dvec3 Normal(std::uint32_t triangle) const;
  // Index of the triangle's mesh in Scene::meshes; lamps and then objects' meshes count on behind them.
  std::uint32_t MeshOf(std::uint32_t triangle) const;

 private:
  template <class Function>
  void ForEachHit(const Camera& camera, const View& view, const Function& function) const;

  const RayScene& scene_;
  int jobs_;
};

}  // namespace sim
