#include "embree_device.h"

#include <tbb/task_arena.h>

#include "watertight.h"

namespace etendue {
namespace {

const char* reason(RTCError code) {
  switch (code) {
    case RTC_ERROR_INVALID_ARGUMENT: return "an argument is not valid";
    case RTC_ERROR_INVALID_OPERATION: return "the operation is not allowed";
    case RTC_ERROR_OUT_OF_MEMORY: return "not enough memory";
    case RTC_ERROR_UNSUPPORTED_CPU: return "this processor is not supported";
    case RTC_ERROR_CANCELLED: return "it was cancelled";
    default: return "unknown error";
  }
}

}  // namespace

RTCDevice embree_device() {
  // Never released: at the program's end statics may be destroyed in any order, and scenes after the device.
  static const RTCDevice device = [] {
    RTCDevice d = rtcNewDevice(nullptr);
    if (!d) throw Error(std::string("Embree cannot start: ") + reason(rtcGetDeviceError(nullptr)));
    return d;
  }();
  return device;
}

void check_embree(const char* doing) {
  const RTCError code = rtcGetDeviceError(embree_device());
  if (code != RTC_ERROR_NONE) throw Error(std::string("Embree failed ") + doing + ": " + reason(code));
}

unsigned attach_triangles(RTCScene scene, const TriangleView& view, RTCBuildQuality quality) {
  RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, view.positions.data(), 0, sizeof(Point3),
                             view.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view.triangles.data(), 0,
                             3 * sizeof(std::uint32_t), view.triangles.size());
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);  // the scene keeps a reference to it
  check_embree("taking in triangles");
  return id;
}

// Embree's motion keys are evenly spaced in time. If the view's keys are not, each interval between two keys becomes a separate
// geometry that exists only in this interval's time range.
void attach_moving_triangles(RTCScene scene, const MovingTriangleView& view, RTCBuildQuality quality,
                             const std::function<void(unsigned)>& attached) {
  const size_t steps = view.times.size() - 1;
  const EmbreeClock clock{view.times.front(), view.times.back()};
  bool even = steps < RTC_MAX_TIME_STEP_COUNT;
  for (size_t i = 1; i < steps; ++i)
    even = even && std::abs(clock(view.times[i]) - float(i) / float(steps)) <= 2 * std::numeric_limits<float>::epsilon();
  const size_t span = even ? steps : 1;  // steps of one geometry
  for (size_t first = 0; first < steps; first += span) {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcSetGeometryTimeStepCount(geometry, unsigned(span + 1));
    if (!even) rtcSetGeometryTimeRange(geometry, clock(view.times[first]), clock(view.times[first + 1]));
    for (size_t k = 0; k <= span; ++k)
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, unsigned(k), RTC_FORMAT_FLOAT3,
                                 view.positions.data() + (first + k) * view.vertices, 0, sizeof(Point3), view.vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view.triangles.data(), 0,
                               3 * sizeof(std::uint32_t), view.triangles.size());
    rtcCommitGeometry(geometry);
    attached(rtcAttachGeometry(scene, geometry));
    rtcReleaseGeometry(geometry);  // the scene keeps a reference to it
  }
  check_embree("taking in moving triangles");
}

float exact_distance(const MovingTriangleView& view, std::uint32_t triangle, const Ray& ray) {
  const MovingTriangleView::Moment now = view.moment(ray.time);
  const auto& t = view.triangles[triangle];
  const Point3 p[3] = {view.position(t[0], now), view.position(t[1], now), view.position(t[2], now)};
  return float(plane_distance(ShearedRay<double>(ray), [&p](int k, int axis) { return double(p[k][axis]); }));
}

EmbreeTriangles::EmbreeTriangles(const MovingTriangleView& view) : scene_(rtcNewScene(embree_device())), view_(view) {
  check_embree("making a scene");
  rtcSetSceneFlags(scene_.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | embree_filter_flag));
  if (view.times.empty()) {
    attach_triangles(scene_.get(), {view.positions.first(view.vertices), view.triangles}, RTC_BUILD_QUALITY_MEDIUM);
  } else {
    clock_ = {view.times.front(), view.times.back()};
    attach_moving_triangles(scene_.get(), view, RTC_BUILD_QUALITY_MEDIUM, [](unsigned) {});
  }
  // Isolated: a thread that waits here within a parallel loop must not execute other iterations of that loop.
  tbb::this_task_arena::isolate([this] { rtcCommitScene(scene_.get()); });
  check_embree("building over triangles");
}

bool EmbreeTriangles::nearest(const Ray& ray, float& t, std::uint32_t& triangle, float& u, float& v) const {
  EmbreeContext context;
  RTCRayHit query;
  set_embree_ray(query.ray, ray, clock_);
  while (true) {
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(scene_.get(), context, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    t = exact_distance(view_, query.hit.primID, ray);
    if (t > 0 && t < ray.maximum) [[likely]]
      break;
    go_on_behind(query.ray, ray);
  }
  triangle = query.hit.primID;
  u = query.hit.u;
  v = query.hit.v;
  return true;
}

bool EmbreeTriangles::any(const Ray& ray) const {
  struct Context {
    EmbreeContext embree;
    const EmbreeTriangles& triangles;
    const Ray& ray;
  } context{{}, *this, ray};
  const RTCFilterFunctionN filter = [](const RTCFilterFunctionNArguments* arguments) {
    const Context& c = *reinterpret_cast<const Context*>(arguments->context);
    const RTCHit& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    const float t = exact_distance(c.triangles.view_, hit.primID, c.ray);
    if (!(t > 0 && t < c.ray.maximum)) arguments->valid[0] = 0;
  };
  RTCRay query;
  set_embree_ray(query, ray, clock_);
  embree_occluded(scene_.get(), context.embree, query, filter);
  return query.tfar < 0;
}

}  // namespace etendue
