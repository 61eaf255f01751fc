// Box: a box with its edges along the axes in object space.

#include "etendue/placed_object.h"
#include "geometry/double_ray.h"
#include "geometry/geometry.h"

namespace etendue {
namespace {

// Face 2 k + s is perpendicular to axis k, at its low (s = 0) or high (s = 1) end. On a face u and v run along the next two
// axes, so that dpdu x dpdv is along +k; on a low face u is reversed, so that the front is outside.
class Box final : public PlacedObject {
 public:
  static void describe(Description<Box>& d) {
    d.summary(
         "A box with edges along the axes. Each face has its own surface coordinates from 0 to 1: on that which faces +x u "
         "goes "
         "along y and v along z, on +y along z and x, on +z along x and y; on those that face back u runs the other way.",
         "slabs: Kay & Kajiya 1986, \"Ray tracing complex scenes\"")
        .group("Shape")
        .member<&Box::centre>("centre", "m", "its middle", Effect::rebuild)
        .member<&Box::size>("size", "m", "its edges", Effect::rebuild);
  }

  void prepare() override {
    if (!is_finite(centre)) fail("centre", "must be finite");
    for (int k = 0; k < 3; ++k)
      if (!(size[k] > 0 && size[k] < infinity)) fail("size", "all edges must be positive and finite");
    use_scene_origin(transform);
    const DoubleVector3 middle = centre - transform.inner_origin(), half = 0.5 * DoubleVector3(size);
    low_ = Point3(DoublePoint3{} + (middle - half));
    high_ = Point3(DoublePoint3{} + (middle + half));
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      for (const int face : {2 * k, 2 * k + 1}) {
        sum += double(size[next(k)]) * double(size[next(next(k))]);
        until_[face] = sum;
      }
    place();
  }

  bool closed() const override { return true; }

  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    const Seen seen = faces_seen(t.back(from), t);
    SurfaceSample s;
    float x = u.x * seen.area;
    for (int face = 0; face < 6; ++face) {
      if (!(seen.areas[face] > 0)) continue;
      if (x < seen.areas[face] || face == seen.last) {
        LocalPoint own;
        point_on(face, {std::min(x / seen.areas[face], one_minus_epsilon), u.y}, own);
        carry(own, time, s.point);
        complete_by_area(s, from, 1 / seen.area);
        return s;
      }
      x -= seen.areas[face];
    }
    return s;
  }

  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    const Seen seen = faces_seen(t.back(from), t);
    const float cosine = std::abs(dot(p.normal, direction));
    return seen.areas[p.primitive] > 0 && cosine > 0 ? distance_squared(p.position, from) / (cosine * seen.area) : 0;
  }

  DoublePoint3 centre{0, 0, 0};
  Vector3 size{1, 1, 1};

 protected:
  Bounds3 local_bounds() const override {
    Bounds3 box;
    box.add(low_);
    box.add(high_);
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoubleRay r(ray);
    double enter = -infinity, leave = infinity;
    int in = 0, out = 0;
    for (int k = 0; k < 3; ++k) {
      const double inverse = 1 / r.direction[k];
      double t0 = (double(low_[k]) - r.origin[k]) * inverse, t1 = (double(high_[k]) - r.origin[k]) * inverse;
      const bool backwards = inverse < 0;
      if (backwards) std::swap(t0, t1);
      // For a ray parallel to a slab both are infinite; in the plane of a face they may be NaN, and the interval is unchanged.
      if (t0 > enter) enter = t0, in = 2 * k + backwards;
      if (t1 < leave) leave = t1, out = 2 * k + !backwards;
    }
    if (enter > leave) return false;
    const float near = float(enter), far = float(leave), t = near > 0 ? near : far;
    if (!(t > 0 && t < ray.maximum)) return false;
    hit.distance = t;
    hit.primitive = std::uint32_t(near > 0 ? in : out);
    hit.u = 0;
    hit.v = 0;
    return true;
  }

  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoubleRay r(ray);
    const int face = int(hit.primitive), k = face / 2;
    float x[3];
    for (int i = 0; i < 3; ++i) x[i] = within_face(i, float(r.at(double(hit.distance), i)));
    const int a = next(k), b = next(a);
    const float along = clamp((x[a] - low_[a]) / size[a], 0, 1);
    point_on(face, {face % 2 ? along : 1 - along, clamp((x[b] - low_[b]) / size[b], 0, 1)}, p);
    x[k] = face % 2 ? high_[k] : low_[k];
    p.position = {x[0], x[1], x[2]};
  }

  double local_area() const override { return until_[5]; }

  Seams local_seams() const override {
    Seams seams;
    for (int face = 0; face < 5; ++face) seams.x.push_back(until_[face] / until_[5]);
    return seams;
  }

  float local_sample(Point2 u, LocalPoint& p) const override {
    double x = double(u.x) * until_[5];
    int face = 0;
    while (face < 5 && x >= until_[face]) ++face;
    if (face > 0) x -= until_[face - 1];
    const double width = until_[face] - (face > 0 ? until_[face - 1] : 0);
    point_on(face, {std::min(float(x / width), one_minus_epsilon), u.y}, p);
    return float(1 / until_[5]);
  }

 private:
  static int next(int k) { return (k + 1) % 3; }
  float within_face(int axis, float x) const { return float(within(double(x), double(low_[axis]), double(high_[axis]))); }

  void point_on(int face, Point2 at, LocalPoint& p) const {
    const int k = face / 2, a = next(k), b = next(a);
    const float side = face % 2 ? 1.0f : -1.0f;
    float x[3], n[3]{}, du[3]{}, dv[3]{};
    x[k] = face % 2 ? high_[k] : low_[k];
    x[a] = within_face(a, low_[a] + (face % 2 ? at.x : 1 - at.x) * size[a]);
    x[b] = within_face(b, low_[b] + at.y * size[b]);
    n[k] = side;
    du[a] = side * size[a];
    dv[b] = size[b];
    p.position = {x[0], x[1], x[2]};
    p.normal = {n[0], n[1], n[2]};
    p.dpdu = {du[0], du[1], du[2]};
    p.dpdv = {dv[0], dv[1], dv[2]};
    p.uv = at;
    p.primitive = std::uint32_t(face);
    p.u = p.v = 0;
    // Rounding of the face's position and of offset ray origins.
    p.error = rounding_bound(4) * (2 * std::abs(x[k]) + size[k]);
  }

  /// World-space areas of the faces that are visible from a point: those in front of which it lies, or all faces from inside.
  struct Seen {
    float areas[6]{}, area = 0;
    int last = 0;
  };
  Seen faces_seen(const Point3& own, const Transform& t) const {
    Seen seen;
    const bool inside = local_bounds().contains(own);
    for (int face = 0; face < 6; ++face) {
      const int k = face / 2;
      if (!inside && !(face % 2 ? own[k] > high_[k] : own[k] < low_[k])) continue;
      float n[3]{};
      n[k] = 1;
      seen.areas[face] = size[next(k)] * size[next(next(k))] * t.area_stretch({n[0], n[1], n[2]});
      seen.area += seen.areas[face];
      seen.last = face;
    }
    return seen;
  }

  Point3 low_, high_;
  double until_[6]{};  // cumulative areas of the faces
};

const Register<Box> registered;

}  // namespace
}  // namespace etendue
