// Purpose: Embree 3 (Debian 12) or 4 behind the few calls that we use. Private to sim/render.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace sim {

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
#else
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
