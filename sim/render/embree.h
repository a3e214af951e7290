// Ray queries of Embree 3 (Debian 12) or 4. Private to sim/render and sim/light.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace sim {

// Intersect: the nearest hit; Occluded: any. Scenes of objects (instances) are asked without the coherent flag: with
// it, rtcOccluded16 of Embree 3.13.5 does not return where no instance has motion blur.
#if RTC_VERSION_MAJOR >= 4
static inline void IntersectCoherent16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, rays, &arguments);
}
static inline void OccludedCoherent16(const int* valid, RTCScene scene, RTCRay16* rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, rays, &arguments);
}
static inline void IntersectObjects16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
  rtcIntersect16(valid, scene, rays, nullptr);
}
static inline void OccludedObjects16(const int* valid, RTCScene scene, RTCRay16* rays) {
  rtcOccluded16(valid, scene, rays, nullptr);
}
static inline void Intersect1(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, ray, nullptr); }
static inline void Occluded1(RTCScene scene, RTCRay* ray) { rtcOccluded1(scene, ray, nullptr); }
#else
static inline void Intersect1(RTCScene scene, RTCRayHit* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, ray);
}
static inline void Occluded1(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, ray);
}
static inline void IntersectObjects16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect16(valid, scene, &context, rays);
}
static inline void OccludedObjects16(const int* valid, RTCScene scene, RTCRay16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, scene, &context, rays);
}
static inline void IntersectCoherent16(const int* valid, RTCScene scene, RTCRayHit16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, rays);
}
static inline void OccludedCoherent16(const int* valid, RTCScene scene, RTCRay16* rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, rays);
}
#endif

}  // namespace sim
