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

}  // namespace sim
