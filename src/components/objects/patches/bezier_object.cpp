#include "bezier_object.h"

#include <tbb/task_arena.h>

#include "bezier_borders.h"
#include "bezier_roots.h"
#include "geometry/embree_device.h"
#include "geometry/geometry.h"

namespace etendue {

using bezier::Vector;

namespace {

/// The state of a ray during traversal.
struct Query {
  EmbreeContext context;  // must be first: Embree passes a pointer to it to the callbacks
  bezier::Line line;
  bezier::Root root;
};

}  // namespace

/// Embree's hierarchy over the bounding boxes of cells, as user geometry.
struct BezierObject::Accelerator {
  Accelerator(const BezierObject& o, const std::vector<Bounds3>& b)
      : object(o), boxes(&b), scene(rtcNewScene(embree_device())) {
    check_embree("making a scene");
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(b.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(geometry, nearest);
    rtcSetGeometryOccludedFunction(geometry, any);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);  // the scene keeps a reference to it
    // Isolated: a thread that waits here within a parallel loop must not execute other iterations of that loop.
    tbb::this_task_arena::isolate([this] { rtcCommitScene(scene.get()); });
    check_embree("building over patches");
    boxes = nullptr;
  }

  static void bounds_of(const RTCBoundsFunctionArguments* a) {
    const Bounds3& box = (*static_cast<const Accelerator*>(a->geometryUserPtr)->boxes)[a->primID];
    *a->bounds_o = {box.low.x, box.low.y, box.low.z, 0, box.high.x, box.high.y, box.high.z, 0};
  }

  /// Finds the nearest root in a cell at a distance below `maximum`, and sets `maximum` to its distance.
  bool meets(EmbreeContext* context, unsigned cell, float& maximum) const {
    Query& q = *reinterpret_cast<Query*>(context);
    const bezier::Cell& c = object.cells_[cell];
    bezier::Root root;
    if (!nearest_root(object.patches_[c.patch], c, q.line, double(maximum), object.region_, root)) return false;
    const float t = float(root.distance);
    if (!(t > 0 && t < maximum)) return false;
    maximum = t;
    q.root = root;
    return true;
  }

  static void nearest(const RTCIntersectFunctionNArguments* a) {
    if (!a->valid[0]) return;
    RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    const auto& self = *static_cast<const Accelerator*>(a->geometryUserPtr);
    if (self.meets(a->context, a->primID, query.ray.tfar)) query.hit.geomID = a->geomID;
  }

  static void any(const RTCOccludedFunctionNArguments* a) {
    if (!a->valid[0]) return;
    RTCRay& ray = *reinterpret_cast<RTCRay*>(a->ray);
    const auto& self = *static_cast<const Accelerator*>(a->geometryUserPtr);
    if (float maximum = ray.tfar; self.meets(a->context, a->primID, maximum)) ray.tfar = -infinity;
  }

  static Query query(const Ray& ray) {
    Query q;
    q.line = {{double(ray.origin.x), double(ray.origin.y), double(ray.origin.z)},
              {double(ray.direction.x), double(ray.direction.y), double(ray.direction.z)}};
    return q;
  }

  const BezierObject& object;
  const std::vector<Bounds3>* boxes;  // valid only while the hierarchy is built
  EmbreeSceneHandle scene;
};

BezierObject::BezierObject() = default;
BezierObject::~BezierObject() = default;

int BezierObject::grid_for(std::size_t patches) {
  return std::clamp(int(std::sqrt(262144.0 / double(std::max<std::size_t>(patches, 1)))), 1, 16);
}

bool BezierObject::adopt(std::vector<bezier::Patch> patches, bezier::Region region) {
  patches_ = std::move(patches);
  region_ = std::move(region);
  closed_ = !region_.trimmed() && bezier::close(patches_);
  table_ = {patches_, region_};
  if (!(table_.area() > 0)) return false;
  cells_.clear();
  std::vector<bezier::Cell> all;
  std::vector<Bounds3> boxes, kept;
  for (size_t i = 0; i < patches_.size(); ++i) bezier::cut(patches_[i], std::uint32_t(i), all, boxes);
  own_bounds_ = {};
  for (size_t i = 0; i < all.size(); ++i) {
    const bezier::Cell& c = all[i];
    if (!region_.touches(c.patch, c.s - c.s_half, c.s + c.s_half, c.t - c.t_half, c.t + c.t_half)) continue;
    cells_.push_back(c);
    kept.push_back(boxes[i]);
    own_bounds_.add(boxes[i]);
  }
  cells_.shrink_to_fit();
  accelerator_ = std::make_unique<Accelerator>(*this, kept);
  place();
  return true;
}

bool BezierObject::local_intersect(const Ray& ray, Hit& hit) const {
  Query q = Accelerator::query(ray);
  RTCRayHit query;
  set_embree_ray(query.ray, ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(accelerator_->scene.get(), q.context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.distance = query.ray.tfar;
  hit.primitive = q.root.patch;
  hit.u = float(q.root.s);
  hit.v = float(q.root.t);
  return true;
}

bool BezierObject::local_occludes(const Ray& ray) const {
  Query q = Accelerator::query(ray);
  RTCRay query;
  set_embree_ray(query, ray);
  embree_occluded(accelerator_->scene.get(), q.context, query);
  return query.tfar < 0;
}

void BezierObject::local_point(const Ray&, const Hit& hit, LocalPoint& p) const { point_at(hit.primitive, hit.u, hit.v, p); }

double BezierObject::point_at(std::uint32_t number, float s, float t, LocalPoint& p) const {
  const bezier::Patch& patch = patches_[number];
  const bezier::Derivatives d = evaluate(patch, double(s), double(t));
  const Vector n = (patch.flipped ? -1.0 : 1.0) * normal(patch, double(s), double(t), d);
  const auto to_float = [](double f, const Vector& v) { return Vector3{float(f * v.x), float(f * v.y), float(f * v.z)}; };
  p.position = Point3{} + to_float(1, d.position);
  p.normal = Normal3(to_float(1, n));
  const double du = patch.high[0] - patch.low[0], dv = patch.high[1] - patch.low[1];
  p.dpdu = to_float(1 / du, d.ds);
  p.dpdv = to_float(1 / dv, d.dt);
  p.uv = {float(patch.low[0] + double(s) * du), float(patch.low[1] + double(t) * dv)};
  p.primitive = number;
  p.u = s;
  p.v = t;
  // The position is on the surface, rounded; offsetting a ray's origin rounds again. Solver and evaluation agree to about 1e-15
  // of the patch's size.
  p.error = rounding_bound(3) * along(p.normal, abs(p.position - Point3{})) + float(1e-12 * patch.size);
  return length(cross(d.ds, d.dt));
}

float BezierObject::local_sample(Point2 u, LocalPoint& p) const {
  const bezier::AreaTable::Choice c = table_.choose(u, region_);
  return float(table_.pdf(c.patch, c.s, c.t) / point_at(c.patch, c.s, c.t, p));
}

float BezierObject::local_pdf(const SurfacePoint& p) const {
  const bezier::Derivatives d = evaluate(patches_[p.primitive], double(p.u), double(p.v));
  return float(table_.pdf(p.primitive, p.u, p.v) / length(cross(d.ds, d.dt)));
}

}  // namespace etendue
