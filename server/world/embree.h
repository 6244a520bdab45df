// SPDX-License-Identifier: Apache-2.0
// Hides which Embree this is: 3 (contexts carry flags) or 4 (arguments carry contexts). Only
// world*.cpp include it.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace wellspring::world::embree {

#if RTC_VERSION_MAJOR >= 4

using Context = RTCRayQueryContext;
inline void init(Context& context) { rtcInitRayQueryContext(&context); }

inline RTCIntersectArguments intersect_arguments(Context& context, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return arguments;
}
// Scenes are built with this flag so that rays may bring a filter of their own.
constexpr RTCSceneFlags ray_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
// Traces a ray; `filter` is asked after the geometry's own.
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray,
                       RTCFilterFunctionN filter = nullptr) {
  RTCIntersectArguments arguments = intersect_arguments(context, false);
  arguments.filter = filter;
  if (filter)
    arguments.flags = RTCRayQueryFlags(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect8(RTCScene scene, Context& context, const int* valid, RTCRayHit8& rays) {
  RTCIntersectArguments arguments = intersect_arguments(context, true);
  rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}
inline RTCOccludedArguments occluded_arguments(Context& context) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  return arguments;
}
inline void occluded(RTCScene scene, Context& context, const int* valid, RTCRay8& rays) {
  RTCOccludedArguments arguments = occluded_arguments(context);
  rtcOccluded8(valid, scene, &rays, &arguments);
}
inline void occluded(RTCScene scene, Context& context, const int* valid, RTCRay16& rays) {
  RTCOccludedArguments arguments = occluded_arguments(context);
  rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

using Context = RTCIntersectContext;
inline void init(Context& context) { rtcInitIntersectContext(&context); }

constexpr RTCSceneFlags ray_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray,
                       RTCFilterFunctionN filter = nullptr) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
}
inline void intersect8(RTCScene scene, Context& context, const int* valid, RTCRayHit8& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &rays);
}
inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcOccluded1(scene, &context, &ray);
}
inline void occluded(RTCScene scene, Context& context, const int* valid, RTCRay8& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &context, &rays);
}
inline void occluded(RTCScene scene, Context& context, const int* valid, RTCRay16& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace wellspring::world::embree
