#pragma once
// One interface to Embree 3 and Embree 4, whose ray queries have different arguments. In Embree 3 the context holds the filter
// function of a query; in Embree 4 a structure of arguments holds the filter function and points to the context. All other code
// uses what both versions have in common, and the names of this file. The build chooses the version.

#ifdef ETENDUE_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace etendue {

#ifdef ETENDUE_EMBREE_4

/// The state of a query: Embree passes its address to the callbacks, so a structure that begins with it can hold their data.
using EmbreeContext = RTCRayQueryContext;

/// The scene flag without which queries have no filter function.
inline constexpr RTCSceneFlags embree_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

namespace embree_detail {

template <class Arguments>
void set_arguments(Arguments& arguments, EmbreeContext& context, RTCFilterFunctionN filter) {
  rtcInitRayQueryContext(&context);
  arguments.context = &context;
  arguments.filter = filter;
  if (filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
}

}  // namespace embree_detail

/// Finds the nearest hit. Initializes the context; the filter function may reject hits on Embree's own geometry.
inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& query, RTCFilterFunctionN filter = nullptr) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  embree_detail::set_arguments(arguments, context, filter);
  rtcIntersect1(scene, &query, &arguments);
}

/// Finds any hit: sets tfar to minus infinity if there is one.
inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& query, RTCFilterFunctionN filter = nullptr) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  embree_detail::set_arguments(arguments, context, filter);
  rtcOccluded1(scene, &query, &arguments);
}

#else

using EmbreeContext = RTCIntersectContext;

inline constexpr RTCSceneFlags embree_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void embree_intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  rtcIntersect1(scene, &context, &query);
}

inline void embree_occluded(RTCScene scene, EmbreeContext& context, RTCRay& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  rtcOccluded1(scene, &context, &query);
}

#endif

}  // namespace etendue
