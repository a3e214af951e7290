// Ray queries of Embree 3 (Debian 12) or 4. Private to sim/render and sim/light.
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace sim {

// Intersect: the nearest hit; Occluded: any. Queries of scenes with instances do not set the coherent flag: with it,
// rtcOccluded16 of Embree 3.13.5 does not return where no instance has motion blur.
#if RTC_VERSION_MAJOR >= 4
static inline void Intersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, rays, &arguments);
}
static inline void Occluded16(const int* valid, RTCScene scene, RTCRay16* rays, bool coherent) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, rays, &arguments);
}
static inline void Intersect1(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, ray, nullptr); }
static inline void Occluded1(RTCScene scene, RTCRay* ray) { rtcOccluded1(scene, ray, nullptr); }
#else
static inline RTCIntersectContext EmbreeContext(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}
static inline void Intersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, bool coherent) {
  RTCIntersectContext context = EmbreeContext(coherent);
  rtcIntersect16(valid, scene, &context, rays);
}
static inline void Occluded16(const int* valid, RTCScene scene, RTCRay16* rays, bool coherent) {
  RTCIntersectContext context = EmbreeContext(coherent);
  rtcOccluded16(valid, scene, &context, rays);
}
static inline void Intersect1(RTCScene scene, RTCRayHit* ray) {
  RTCIntersectContext context = EmbreeContext(false);
  rtcIntersect1(scene, &context, ray);
}
static inline void Occluded1(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context = EmbreeContext(false);
  rtcOccluded1(scene, &context, ray);
}
#endif

static inline RTCRay MakeRay(const glm::dvec3& origin, const glm::dvec3& direction, float far, float near = 0) {
  const glm::vec3 o(origin), d(direction);
  RTCRay ray{};
  ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
  ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
  ray.tnear = near, ray.tfar = far;
  ray.mask = 0xffffffffu;
  return ray;
}
static inline RTCRayHit Cast(RTCScene scene, const glm::dvec3& origin, const glm::dvec3& direction,
                             float far = std::numeric_limits<float>::infinity(), float near = 0) {
  RTCRayHit ray{};
  ray.ray = MakeRay(origin, direction, far, near);
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  Intersect1(scene, &ray);
  return ray;
}

}  // namespace sim
