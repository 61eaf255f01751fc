#include "curve_pieces.h"

#include <tbb/task_arena.h>

namespace etendue {
namespace {

/// Data for the callbacks: Embree passes the address of the context to them.
struct Context {
  EmbreeContext embree;
  const DoubleRay* ray;
  Hit* hit;
};

void bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const Bounds3 box = static_cast<const Pieces*>(arguments->geometryUserPtr)->piece_bounds(arguments->primID);
  RTCBounds& b = *arguments->bounds_o;
  b.lower_x = box.low.x;
  b.lower_y = box.low.y;
  b.lower_z = box.low.z;
  b.upper_x = box.high.x;
  b.upper_y = box.high.y;
  b.upper_z = box.high.z;
}

void intersect(const RTCIntersectFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const Context& context = *reinterpret_cast<const Context*>(arguments->context);
  const Pieces& pieces = *static_cast<const Pieces*>(arguments->geometryUserPtr);
  if (!pieces.intersect_piece(arguments->primID, *context.ray, query.ray.tfar, *context.hit)) return;
  query.ray.tfar = context.hit->distance;
  query.hit.geomID = arguments->geomID;
  query.hit.primID = arguments->primID;
}

void occluded(const RTCOccludedFunctionNArguments* arguments) {
  if (!arguments->valid[0]) return;
  RTCRay& query = *reinterpret_cast<RTCRay*>(arguments->ray);
  const Context& context = *reinterpret_cast<const Context*>(arguments->context);
  const Pieces& pieces = *static_cast<const Pieces*>(arguments->geometryUserPtr);
  Hit hit;
  if (pieces.intersect_piece(arguments->primID, *context.ray, query.tfar, hit)) query.tfar = -infinity;
}

}  // namespace

PieceHierarchy::PieceHierarchy(const Pieces& pieces, std::uint32_t count) : scene_(rtcNewScene(embree_device())) {
  check_embree("making a scene");
  // Robust: boxes of hairs are so thin that rounding would let rays from afar miss them.
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, count);
  rtcSetGeometryUserData(geometry, const_cast<Pieces*>(&pieces));
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);  // the scene keeps a reference to it
  check_embree("taking in pieces of curves");
  // Isolated: a thread that waits here within a parallel loop must not execute other iterations of that loop.
  tbb::this_task_arena::isolate([this] { rtcCommitScene(scene_.get()); });
  check_embree("building over pieces of curves");
}

bool PieceHierarchy::nearest(const Ray& ray, Hit& hit) const {
  const DoubleRay exact(ray);
  Context context{{}, &exact, &hit};
  RTCRayHit query;
  set_embree_ray(query.ray, ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(scene_.get(), context.embree, query);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool PieceHierarchy::any(const Ray& ray) const {
  const DoubleRay exact(ray);
  Context context{{}, &exact, nullptr};
  RTCRay query;
  set_embree_ray(query, ray);
  embree_occluded(scene_.get(), context.embree, query);
  return query.tfar < 0;
}

}  // namespace etendue
